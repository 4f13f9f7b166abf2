// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/window.h"

#include "base/constants.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// sinh(s)/s for s^2 of either sign.
double sinhc_of_square(double s2)
{
  const double s = std::sqrt(std::fabs(s2));
  if (s < 1e-4) return 1.0 + s2 / 6.0;
  return s2 > 0.0 ? std::sinh(s) / s : std::sin(s) / s;
}

}    // namespace

double Window::value(double u) const
{
  const double z = 2.0 * u / width, q = 1.0 - z * z;
  return q < 0.0 ? 0.0 : std::cyl_bessel_i(0.0, beta * std::sqrt(q)) / std::cyl_bessel_i(0.0, beta);
}

double Window::transform(double kappa) const
{
  const double half = 0.5 * kappa * width;
  return width * sinhc_of_square(beta * beta - half * half) / std::cyl_bessel_i(0.0, beta);
}

double Window::alias(double kappa, int m) const
{
  const double half = 0.5 * width, near = half * kappa, far = half * (kappa + two_pi * m);
  return sinhc_of_square(beta * beta - far * far) / sinhc_of_square(beta * beta - near * near);
}

WindowPolynomials::WindowPolynomials(const Window &window, double error) : width_(window.width)
{
  constexpr int most = 24;    // enough for W = 16 in double precision
  for (degree_ = 2; degree_ < most; ++degree_) {
    fit(window, degree_);
    if (error_ <= error) break;
  }
}

/// Interpolates at Chebyshev points, line by line, and converts to powers of t.
void WindowPolynomials::fit(const Window &window, int degree)
{
  const int count = degree + 1;
  coefficients_.assign(count * width_, 0.0);
  error_ = 0.0;
  for (int line = 0; line < width_; ++line) {
    const auto exact = [&](double t) {
      return window.value(0.5 * (t + 1.0) + line - 0.5 * width_);
    };
    std::vector<double> chebyshev(count, 0.0);
    for (int j = 0; j < count; ++j) {
      const double angle = pi * (j + 0.5) / count, f = exact(std::cos(angle));
      for (int k = 0; k < count; ++k)
        chebyshev[k] += (k ? 2.0 : 1.0) / count * f * std::cos(k * angle);
    }
    // Powers of T_k by its recurrence T_{k+1} = 2 t T_k - T_{k-1}.
    std::vector<double> before(count, 0.0), now(count, 0.0), power(count, 0.0);
    before[0] = 1.0;
    if (count > 1) now[1] = 1.0;
    for (int k = 0; k < count; ++k) {
      const std::vector<double> &T = k == 0 ? before : now;
      for (int p = 0; p < count; ++p) power[p] += chebyshev[k] * T[p];
      if (k == 0) continue;
      std::vector<double> next(count, 0.0);
      for (int p = 0; p < count; ++p) next[p] = (p ? 2.0 * now[p - 1] : 0.0) - before[p];
      before = now;
      now = next;
    }
    for (int k = 0; k < count; ++k) coefficients_[(degree - k) * width_ + line] = power[k];
    for (int s = 0; s <= 40; ++s) {
      const double t = -1.0 + s / 20.0;
      double p = 0.0;
      for (int k = degree; k >= 0; --k) p = p * t + power[k];
      error_ = std::max(error_, std::fabs(p - exact(t)));
    }
  }
}

}    // namespace bdh
