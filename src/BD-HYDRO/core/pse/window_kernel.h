// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The grid lines along one axis under the window of the non-uniform Fourier transform, and their
/// weights (see WindowPolynomials).
#ifndef BDH_PSE_WINDOW_KERNEL_H
#define BDH_PSE_WINDOW_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// First line under a window of `width` lines at x (in spacings).  Sets t to the argument of the
/// polynomials, in [-1, 1).
BDH_FN double first_window_line(double x, int width, double &t)
{
  const double edge = x - 0.5 * width, line = std::ceil(edge);
  t = 2.0 * (line - edge) - 1.0;
  return line;
}

/// The derivative of that argument with respect to the position in spacings.
constexpr int window_slope = -2;

/// Weight of line first + i, a polynomial in t.  The coefficients are [degree + 1][width] with the
/// highest power first.
template <class Real>
BDH_FN Real window_weight(const Real *coefficient, int width, int degree, int i, Real t)
{
  Real w = coefficient[i];
  for (int k = 1; k <= degree; ++k) w = w * t + coefficient[k * width + i];
  return w;
}

/// The derivative of that weight with respect to the position [1/spacing].
template <class Real>
BDH_FN Real window_slope_at(const Real *coefficient, int width, int degree, int i, Real t)
{
  Real w = coefficient[i], slope = 0;
  for (int k = 1; k <= degree; ++k) {
    slope = slope * t + w;
    w = w * t + coefficient[k * width + i];
  }
  return window_slope * slope;
}

}    // namespace bdh
#endif
