// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Polynomials through Chebyshev points, in powers of their argument.
#ifndef BDH_BASE_CHEBYSHEV_H
#define BDH_BASE_CHEBYSHEV_H

#include "base/constants.h"

#include <cmath>
#include <vector>

namespace bdh {

/// Finds the polynomial through values at the Chebyshev points of [-1, 1].
class ChebyshevFit {
 public:
  explicit ChebyshevFit(int degree) : count_(degree + 1), power_(count_ * count_, 0.0)
  {
    // The powers of t in T_m follow from T_(m+1) = 2 t T_m - T_(m-1).  They are integers, hence
    // exact.
    const auto at = [&](int m, int p) -> double & { return power_[m * count_ + p]; };
    at(0, 0) = 1.0;
    if (count_ > 1) at(1, 1) = 1.0;
    for (int m = 2; m < count_; ++m)
      for (int p = 0; p < count_; ++p)
        at(m, p) = (p > 0 ? 2.0 * at(m - 1, p - 1) : 0.0) - at(m - 2, p);
  }

  /// The number of points, and of coefficients.
  int count() const { return count_; }
  /// A point, j = 0 .. count - 1.
  double point(int j) const { return std::cos(pi * (j + 0.5) / count_); }
  /// The extrema of the polynomial whose zeros are the points, j = 0 .. count.  The error is
  /// largest near them.
  double between_points(int j) const { return std::cos(pi * j / count_); }

  /// Returns the coefficients, lowest power first, of the polynomial that has values[j] at
  /// point(j).
  std::vector<double> coefficients(const std::vector<double> &values) const
  {
    std::vector<double> c(count_, 0.0);
    for (int m = 0; m < count_; ++m) {
      double weight = 0.0;    // the coefficient of T_m
      for (int j = 0; j < count_; ++j) weight += values[j] * std::cos(pi * m * (j + 0.5) / count_);
      weight *= (m == 0 ? 1.0 : 2.0) / count_;
      for (int p = 0; p < count_; ++p) c[p] += weight * power_[m * count_ + p];
    }
    return c;
  }

 private:
  int count_;
  std::vector<double> power_;    // [T_m][power]
};

/// The value at t of the polynomial with coefficients c, lowest power first.
inline double horner(const std::vector<double> &c, double t)
{
  double sum = 0.0;
  for (std::size_t p = c.size(); p-- > 0;) sum = sum * t + c[p];
  return sum;
}

}    // namespace bdh
#endif
