// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "base/lanczos.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace bdh {

void Tridiagonal::clear()
{
  alpha_.clear();
  beta_.clear();
}

void Tridiagonal::add(double alpha, double beta)
{
  alpha_.push_back(alpha);
  beta_.push_back(beta);
}

void Tridiagonal::root(double slack, std::vector<double> &coefficients) const
{
  const Eigen::Index m = size();
  const Eigen::VectorXd diagonal = Eigen::Map<const Eigen::VectorXd>(alpha_.data(), m);
  const Eigen::VectorXd beside = Eigen::Map<const Eigen::VectorXd>(beta_.data(), m - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  const Eigen::VectorXd &lambda = solver.eigenvalues();
  if (!(lambda(0) >= -slack * lambda(m - 1)))
    throw NotConverged("Lanczos met an operator that is not positive: smallest eigenvalue " +
                       std::to_string(lambda(0)) + " beside " + std::to_string(lambda(m - 1)));
  coefficients.assign(m, 0.0);
  for (Eigen::Index j = 0; j < m; ++j) {
    const double weight = std::sqrt(std::max(lambda(j), 0.0)) * solver.eigenvectors()(0, j);
    for (Eigen::Index i = 0; i < m; ++i) coefficients[i] += weight * solver.eigenvectors()(i, j);
  }
}

}    // namespace bdh
