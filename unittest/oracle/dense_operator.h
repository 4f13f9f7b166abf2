// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// A dense matrix as an operator for the Lanczos process.
#ifndef BDH_TEST_DENSE_OPERATOR_H
#define BDH_TEST_DENSE_OPERATOR_H

#include "base/aligned.h"
#include "grid/grid.h"

#include <Eigen/Dense>

namespace bdh_test {

class DenseOperator {
 public:
  using Vector = bdh::AlignedVector;
  explicit DenseOperator(const Eigen::MatrixXd &A) : A_(A) {}
  std::size_t size() const { return A_.rows(); }
  std::size_t full_size() const { return size(); }
  double sum(double mine) const { return mine; }
  void apply(const Vector &v, Vector &u)
  {
    u.resize(size());
    Eigen::Map<Eigen::VectorXd>(u.data(), A_.rows()) =
        A_ * Eigen::Map<const Eigen::VectorXd>(v.data(), A_.rows());
    ++products;
  }
  int products = 0;

 private:
  Eigen::MatrixXd A_;
};

}    // namespace bdh_test
#endif
