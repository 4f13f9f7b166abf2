// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Mobility of two spheres of any radii with first moments, i.e. torques and stresslets, in an
/// unbounded fluid: closed forms for all overlaps.
///
/// A force acts on the surface of its sphere, a first moment within the sphere, so that every block
/// is made of derivatives of one function of the distance r of the centers,
///
///     B(r) = 3/4 <|x_i - x_j|>,   b_m = (1/r d/dr)^m B,   K = (Laplacian - grad grad) B,
///
/// where x_i and x_j are anywhere on the surface of a sphere or within it.  K is the velocity by a
/// force; mobilities are in units of 1/(6 pi viscosity).  The average is a polynomial in r with one
/// further term in 1/r, one for separate spheres, one for spheres that overlap in part, and one for
/// a sphere within the other.
#ifndef BDH_PSE_STRAIN_PAIR_KERNEL_H
#define BDH_PSE_STRAIN_PAIR_KERNEL_H

#include "base/portable.h"
#include "pse/shapes_kernel.h"

#include <cmath>

namespace bdh {

/// Derivatives as the blocks need them, all times r^(2m - 4), in [1/length^3] for b as above.
struct PairDerivatives {
  double b2, b3, b4;    ///< b_2, r^2 b_3, r^4 b_4
};

/// Those of sum_n beta[n + 1] r^n with n = -1 .. count - 2.
BDH_FN PairDerivatives derivatives_of(const double *beta, int count, double r)
{
  PairDerivatives d{0.0, 0.0, 0.0};
  double power = 1.0 / (r * r * r * r * r);
  for (int k = 0; k < count; ++k) {
    const double n = k - 1.0, two = n * (n - 2.0) * beta[k] * power, three = two * (n - 4.0);
    d.b2 += two;
    d.b3 += three;
    d.b4 += three * (n - 6.0);
    power *= r;
  }
  return d;
}

/// Of spheres that do not overlap; e: the sum over both of a^2 for a force, moment_shape a^2 for a
/// first moment.
BDH_FN PairDerivatives separate_derivatives(double r, double e)
{
  const double inv_r = 1.0 / r, f = 0.75 * inv_r * inv_r * inv_r, s = e * inv_r * inv_r;
  return {f * (s - 1.0), f * (3.0 - 5.0 * s), f * (35.0 * s - 15.0)};
}

/// Of a force on a sphere of radius a and a first moment of one of radius b; r > 0.
BDH_FN PairDerivatives force_moment(double r, double a, double b)
{
  if (r >= a + b) return separate_derivatives(r, a * a + moment_shape * b * b);
  if (r <= a - b) return {0.0, 0.0, 0.0};
  if (r <= b - a) return {-0.3 / (b * b * b), 0.0, 0.0};
  const double s = a + b, d = a - b, s2 = s * s, d2 = d * d, f = 0.75 / (a * b * b * b);
  const double beta[] = {f * d2 * d2 * d * (a + 5.0 * b) / 240.0,
                         f * s2 * s2 * (4.0 * b - a) / 40.0,
                         f * d2 * d * (a + 3.0 * b) / 16.0,
                         f * s2 * (2.0 * b - a) / 12.0,
                         f * d * s / 16.0,
                         -f * a / 40.0,
                         f / 240.0};
  return derivatives_of(beta, 7, r);
}

/// Of first moments of both; r > 0.
BDH_FN PairDerivatives moment_moment(double r, double a, double b)
{
  if (r >= a + b) return separate_derivatives(r, moment_shape * (a * a + b * b));
  const double greater = std::fmax(a, b);
  if (r <= std::fabs(a - b)) return {-0.3 / (greater * greater * greater), 0.0, 0.0};
  const double s = a + b, d = a - b, s2 = s * s, d2 = d * d, ab = a * b, squares = a * a + b * b,
               f = 0.75 / (ab * ab * ab);
  const double beta[] = {f * d2 * d2 * d2 * (squares + 6.0 * ab) / 640.0,
                         f * s2 * s2 * s * (5.0 * ab - squares) * (3.0 / 280.0),
                         f * d2 * d2 * (squares + 4.0 * ab) / 32.0,
                         f * s2 * s * (3.0 * ab - squares) / 20.0,
                         f * d2 * s2 * (3.0 / 64.0),
                         f * s * (ab - squares) / 40.0,
                         f * squares / 160.0,
                         0.0,
                         -f / 4480.0};
  return derivatives_of(beta, 9, r);
}

}    // namespace bdh
#endif
