// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Immersed-boundary kernels from their published definitions, for comparison: phi for any real
/// argument.
#ifndef BDH_TEST_REFERENCE_KERNEL_H
#define BDH_TEST_REFERENCE_KERNEL_H

#include "fib/spread.h"

#include <Eigen/Dense>
#include <cmath>

namespace bdh_test {

/// Roma, Peskin & Berger 1999, eq. (22).
inline double phi_roma3(double r)
{
  r = std::fabs(r);
  if (r <= 0.5) return (1.0 + std::sqrt(1.0 - 3.0 * r * r)) / 3.0;
  if (r <= 1.5) return (5.0 - 3.0 * r - std::sqrt(1.0 - 3.0 * (1.0 - r) * (1.0 - r))) / 6.0;
  return 0.0;
}

/// Peskin 2002, eq. (6.27).
inline double phi_peskin4(double r)
{
  r = std::fabs(r);
  if (r <= 1.0) return (3.0 - 2.0 * r + std::sqrt(1.0 + 4.0 * r - 4.0 * r * r)) / 8.0;
  if (r <= 2.0) return (5.0 - 2.0 * r - std::sqrt(-7.0 + 12.0 * r - 4.0 * r * r)) / 8.0;
  return 0.0;
}

constexpr double bkp6_second_moment = 59.0 / 60.0 - 0.26925824035672520157;    // sqrt(29)/20

/// Bao, Kaye & Peskin 2016, from the defining conditions: the sums over even and over odd lines are
/// 1/2, the moments 0, K, 0, and the sum of squares does not depend on the position.  Returns the
/// weights of the lines -2 .. 3 for a point 0 <= r <= 1.
inline Eigen::VectorXd bkp6_weights(double r)
{
  Eigen::MatrixXd conditions(5, 6);
  for (int j = 0; j < 6; ++j) {
    const double s = r - (j - 2), even = j % 2 == 0 ? 1.0 : 0.0;
    conditions.col(j) << even, 1.0 - even, s, s * s, s * s * s;
  }
  Eigen::VectorXd values(5);
  values << 0.5, 0.5, 0.0, bkp6_second_moment, 0.0;
  const Eigen::VectorXd null = (Eigen::VectorXd(6) << 1.0, -3.0, 2.0, 2.0, -3.0, 1.0).finished();
  // The member of the family with outermost weight 0; at r = 0 it is the kernel itself.
  const Eigen::VectorXd particular = conditions.leftCols(5).fullPivLu().solve(values);
  Eigen::VectorXd base(6);
  base << particular, 0.0;
  if (r == 0.0) return base;
  const double squares = bkp6_weights(0.0).squaredNorm();
  const double a = null.squaredNorm(), b = 2.0 * base.dot(null), c = base.squaredNorm() - squares;
  const double root = std::sqrt(b * b - 4.0 * a * c);
  // Takes the root that goes continuously to 0 at r = 0; b changes sign on the way.
  return base + null * (b > 0.0 ? -2.0 * c / (b + root) : (root - b) / (2.0 * a));
}

inline double phi_bkp6(double x)
{
  const double below = std::floor(x);
  if (below < -3.0 || below > 2.0) return 0.0;
  // phi(r - line) with r = x - below and line = -below
  return bkp6_weights(x - below)[static_cast<int>(-below) + 2];
}

inline double phi(bdh::IbKernel kernel, double x)
{
  switch (kernel) {
  case bdh::IbKernel::roma3: return phi_roma3(x);
  case bdh::IbKernel::peskin4: return phi_peskin4(x);
  case bdh::IbKernel::bkp6: return phi_bkp6(x);
  }
  return NAN;
}

constexpr bdh::IbKernel all_kernels[] = {bdh::IbKernel::roma3, bdh::IbKernel::peskin4,
                                         bdh::IbKernel::bkp6};

}    // namespace bdh_test
#endif
