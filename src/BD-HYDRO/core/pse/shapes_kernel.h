// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How spheres of any radius are written with two shape functions in wave space.
///
/// A sphere of radius a spreads a force with the shape s_t(ka) = sinc(ka), a torque with
/// s_r(ka) = 3 j_1(ka)/(ka).  The wave-space part replaces both by
///
///     s^(k) = c sinc(k b_1) + (1 - c) sinc(k b_2),   c = (b_2^2 - e)/(b_2^2 - b_1^2),
///
/// with e = a^2 for forces, so that s^ and s_t agree up to k^2: they have the same far field, and
/// the near part, the exact mobility of the pair without the wave-space part, is short-ranged.  A
/// torque needs no more than s^(0) = s_r(0) = 1: its flow i k x T s/(2 viscosity k^2) is transverse
/// without the projection I - k k^T/k^2, so that what its shape has of k^2 cancels the only 1/k^2
/// and acts at contact alone.  (A force needs the projection, which is long-ranged.)  So torques
/// have the e of forces, and spheres of one radius need one function, whatever acts on them.
///
/// With a Kaiser-Bessel splitting (pse/splitting_kernel.h), (1 - k^2 b^2/6) chi^(1/2) takes the
/// place of sinc(k b) H^(1/2), so c is the same; a second term is that of points for all spheres.
///
/// The sum of both parts does not depend on s^.  With b_1^2 the smallest and b_2^2 the largest e,
/// 0 <= c <= 1, and both parts of the mobility are positive up to a greatest xi (pse/planner.h).
#ifndef BDH_PSE_SHAPES_KERNEL_H
#define BDH_PSE_SHAPES_KERNEL_H

#include "base/portable.h"

namespace bdh {

/// A function of two spheres, from its values w11, w12, w22 for the pairs of shapes and the c of
/// both.
template <class Real> BDH_FN Real sum_of_shapes(Real ci, Real cj, Real w11, Real w12, Real w22)
{
  return ci * cj * w11 + (ci * (1 - cj) + cj * (1 - ci)) * w12 + (1 - ci) * (1 - cj) * w22;
}

/// The two shape functions of the particles of a plan.
struct ShapeBasis {
  double b1 = 1.0, b2 = 1.0;    ///< [length]; b1 <= b2
  double moment = 1.0;          ///< e/a^2 of torques, and of stresslets if there are some

  /// True if one function does for all: spheres of one radius.
  BDH_FN bool single() const { return b1 == b2; }
  /// c of a sphere.  e: a^2 or moment a^2 [length^2]
  BDH_FN double coefficient(double e) const
  {
    if (single()) return 0.0;
    // A share by round-off would cost as much as any.
    const double c = (b2 * b2 - e) / (b2 * b2 - b1 * b1);
    return c < 1e-12 ? 0.0 : c > 1.0 - 1e-12 ? 1.0 : c;
  }
};

/// The basis for radii from least to greatest [length].
BDH_FN ShapeBasis shape_basis(double least, double greatest) { return {least, greatest}; }

/// e/a^2 of the shape of first moments, 3 j_1(ka)/(ka).
constexpr double moment_shape = 0.6;

/// The same with stresslets, whose shape must agree with that of first moments up to k^2: unlike
/// that of torques, their flow is long-ranged in these terms.
BDH_FN ShapeBasis stress_basis(double least, double greatest)
{
  return {0.77459666924148337704 * least, greatest, moment_shape};
}

}    // namespace bdh
#endif
