// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/window.h"

#include "base/chebyshev.h"
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
  return q < 0.0 ? 0.0
                 : (std::cyl_bessel_i(0.0, beta * std::sqrt(q)) - step()) /
                       (std::cyl_bessel_i(0.0, beta) - step());
}

double Window::transform(double kappa) const
{
  return width * shape(kappa) / (std::cyl_bessel_i(0.0, beta) - step());
}

double Window::shape(double kappa) const
{
  const double half = 0.5 * kappa * width;
  return sinhc_of_square(beta * beta - half * half) - step() * sinhc_of_square(-half * half);
}

WindowPolynomials::WindowPolynomials(const Window &window, double error) : width_(window.width)
{
  constexpr int most = 24;    // enough for W = 16 in double precision
  for (degree_ = 2; degree_ < most; ++degree_) {
    fit(window, degree_);
    if (error_ <= error) break;
  }
}

/// Line by line.
void WindowPolynomials::fit(const Window &window, int degree)
{
  const ChebyshevFit rule(degree);
  coefficients_.assign(rule.count() * width_, 0.0);
  error_ = 0.0;
  for (int line = 0; line < width_; ++line) {
    const auto exact = [&](double t) {
      return window.value(0.5 * (t + 1.0) + line - 0.5 * width_);
    };
    std::vector<double> values;
    for (int j = 0; j < rule.count(); ++j) values.push_back(exact(rule.point(j)));
    const std::vector<double> power = rule.coefficients(values);
    for (int k = 0; k <= degree; ++k) coefficients_[(degree - k) * width_ + line] = power[k];
    for (int s = 0; s <= 40; ++s) {
      const double t = -1.0 + s / 20.0;
      error_ = std::max(error_, std::fabs(horner(power, t) - exact(t)));
    }
  }
}

}    // namespace bdh
