// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Immersed-boundary kernels: weights along one axis and their derivatives.
///
/// x is a position in units of the spacing, measured from line 0 of the grid lines in question.
/// Each kernel gives the first of its `width` lines and the weights phi(x - line) there, which add
/// up to 1.  The derivative is d phi/d x.
#ifndef BDH_FIB_IB_KERNEL_H
#define BDH_FIB_IB_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// Three points [Roma, Peskin & Berger, J. Comput. Phys. 153 (1999)].
struct Roma3 {
  static constexpr int width = 3;
  BDH_FN static double first(double x, double &r)
  {
    const double middle = std::floor(x + 0.5);
    r = x - middle;    // -1/2 <= r < 1/2
    return middle - 1.0;
  }
  BDH_FN static void weights(double r, double *w)
  {
    const double q = std::sqrt(1.0 - 3.0 * r * r);
    w[0] = (2.0 - 3.0 * r - q) / 6.0;
    w[1] = (1.0 + q) / 3.0;
    w[2] = (2.0 + 3.0 * r - q) / 6.0;
  }
  BDH_FN static void derivatives(double r, double *dw)
  {
    const double dq = -3.0 * r / std::sqrt(1.0 - 3.0 * r * r);
    dw[0] = (-3.0 - dq) / 6.0;
    dw[1] = dq / 3.0;
    dw[2] = (3.0 - dq) / 6.0;
  }
};

/// Four points [Peskin, Acta Numerica 11 (2002), sec. 6].
struct Peskin4 {
  static constexpr int width = 4;
  BDH_FN static double first(double x, double &r)
  {
    const double below = std::floor(x);
    r = x - below;    // 0 <= r < 1
    return below - 1.0;
  }
  BDH_FN static void weights(double r, double *w)
  {
    const double q = std::sqrt(1.0 + 4.0 * r * (1.0 - r));
    w[0] = (3.0 - 2.0 * r - q) / 8.0;
    w[1] = (3.0 - 2.0 * r + q) / 8.0;
    w[2] = (1.0 + 2.0 * r + q) / 8.0;
    w[3] = (1.0 + 2.0 * r - q) / 8.0;
  }
  BDH_FN static void derivatives(double r, double *dw)
  {
    const double dq = (2.0 - 4.0 * r) / std::sqrt(1.0 + 4.0 * r * (1.0 - r));
    dw[0] = (-2.0 - dq) / 8.0;
    dw[1] = (-2.0 + dq) / 8.0;
    dw[2] = (2.0 + dq) / 8.0;
    dw[3] = (2.0 - dq) / 8.0;
  }
};

/// Six points, three continuous derivatives [Bao, Kaye & Peskin, J. Comput. Phys. 316 (2016)].
/// The outermost weight is the root of a quadratic.  All others follow from it by the even-odd and
/// moment conditions.
struct BaoKayePeskin6 {
  static constexpr int width = 6;
  /// Second moment K = 59/60 - sqrt(29)/20, the value that makes the third derivative continuous.
  static constexpr double second_moment = 59.0 / 60.0 - 5.3851648071345040313 / 20.0;
  BDH_FN static double first(double x, double &r)
  {
    const double below = std::floor(x);
    r = x - below;    // 0 <= r < 1
    return below - 2.0;
  }
  /// Coefficients of alpha w^2 + beta w + gamma = 0 for the outermost weight w = phi(r - 3), and
  /// their derivatives.
  BDH_FN static void quadratic(double r, double &beta, double &gamma, double &dbeta, double &dgamma)
  {
    const double K = second_moment, r2 = r * r;
    const double c2 = (161.0 / 36.0 - 59.0 / 6.0 * K + 5.0 * K * K) / 2.0,
                 c4 = (-109.0 / 24.0 + 5.0 * K) / 3.0, c6 = 5.0 / 18.0;
    beta = 9.0 / 4.0 - 1.5 * (K + r2) + (22.0 / 3.0 - 7.0 * K) * r - 7.0 / 3.0 * r2 * r;
    gamma = 0.25 * r2 * (c2 + r2 * (c4 + r2 * c6));
    dbeta = -3.0 * r + (22.0 / 3.0 - 7.0 * K) - 7.0 * r2;
    dgamma = 0.25 * r * (2.0 * c2 + r2 * (4.0 * c4 + r2 * 6.0 * c6));
  }
  BDH_FN static void weights(double r, double *w)
  {
    const double K = second_moment, r2 = r * r, alpha = 28.0;
    double beta, gamma, dbeta, dgamma;
    quadratic(r, beta, gamma, dbeta, dgamma);
    const double p = (-beta + std::sqrt(beta * beta - 4.0 * alpha * gamma)) / (2.0 * alpha);
    const double even = (K + r2) / 8.0 - 1.0 / 16.0,
                 odd = (3.0 * K - 1.0) * r / 12.0 + r2 * r / 12.0;
    const double slope = (4.0 - 3.0 * K) * r / 6.0 - r2 * r / 6.0;
    w[5] = p;                                   // phi(r - 3)
    w[4] = -3.0 * p + even + odd;               // phi(r - 2)
    w[3] = 2.0 * p + 0.25 + slope;              // phi(r - 1)
    w[2] = 2.0 * p + 0.625 - (K + r2) / 4.0;    // phi(r)
    w[1] = -3.0 * p + 0.25 - slope;             // phi(r + 1)
    w[0] = p + even - odd;                      // phi(r + 2)
  }
  BDH_FN static void derivatives(double r, double *dw)
  {
    const double K = second_moment, alpha = 28.0;
    double beta, gamma, dbeta, dgamma;
    quadratic(r, beta, gamma, dbeta, dgamma);
    const double root = std::sqrt(beta * beta - 4.0 * alpha * gamma);
    const double dp = (-dbeta + (beta * dbeta - 2.0 * alpha * dgamma) / root) / (2.0 * alpha);
    const double even = r / 4.0, odd = (3.0 * K - 1.0) / 12.0 + r * r / 4.0,
                 slope = (4.0 - 3.0 * K) / 6.0 - r * r / 2.0;
    dw[5] = dp;
    dw[4] = -3.0 * dp + even + odd;
    dw[3] = 2.0 * dp + slope;
    dw[2] = 2.0 * dp - r / 2.0;
    dw[1] = -3.0 * dp - slope;
    dw[0] = dp + even - odd;
  }
};

}    // namespace bdh
#endif
