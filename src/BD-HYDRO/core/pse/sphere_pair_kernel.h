// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Rotne-Prager-Yamakawa mobility of two spheres of any radii, which may translate and rotate, in
/// an unbounded fluid: closed forms for all overlaps.
///
/// Zuk, Wajnryb, Mizerski, Szymczak, J. Fluid Mech. 741, R5 (2014).  r is the distance of the
/// centers, e the direction from particle j to particle i.  Mobilities are in units of
/// 1/(6 pi viscosity) here, without a radius: [1/length], [1/length^2], [1/length^3].
#ifndef BDH_PSE_SPHERE_PAIR_KERNEL_H
#define BDH_PSE_SPHERE_PAIR_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// A block transverse (I - e e^T) + (transverse + difference) e e^T.
struct PairBlock {
  double transverse, difference;
};

/// Velocity of sphere i by the force on sphere j; r >= 0.
BDH_FN PairBlock sphere_translation(double r, double ai, double aj)
{
  const double sum = ai + aj, between = std::fabs(ai - aj);
  if (r > sum) {
    const double inv_r = 1.0 / r, s = (ai * ai + aj * aj) * inv_r * inv_r, f = 0.75 * inv_r;
    return {f * (1.0 + s / 3.0), f * (1.0 - s)};
  }
  if (r <= between) return {1.0 / std::fmax(ai, aj), 0.0};
  // (16 r^3 (ai + aj) - (d^2 + 3 r^2)^2)/(32 r^3 ai aj) with d = ai - aj; d/r is at most 1.
  const double d = between / r, d2 = d * d, scale = 1.0 / (32.0 * ai * aj);
  const double whole = d2 + 3.0, part = 1.0 - d2;
  return {scale * (16.0 * sum - r * whole * whole), 3.0 * scale * r * part * part};
}

/// Coefficient c of: angular velocity of sphere i = c e x F by the force F on sphere j; r > 0.  By
/// symmetry the velocity of j by a torque T on i is -c e x T.
BDH_FN double sphere_coupling(double r, double ai, double aj)
{
  if (r > ai + aj) return -0.75 / (r * r);
  if (r <= std::fabs(ai - aj)) return ai > aj ? -0.75 * r / (ai * ai * ai) : 0.0;
  const double near = ai - aj + r, rest = aj * aj + 2.0 * aj * (ai + r) - 3.0 * (ai - r) * (ai - r);
  return -0.046875 * near * near * rest / (r * r * ai * ai * ai * aj);
}

/// Angular velocity of sphere i by the torque on sphere j; r >= 0.
BDH_FN PairBlock sphere_rotation(double r, double ai, double aj)
{
  const double sum = ai + aj, between = std::fabs(ai - aj);
  if (r > sum) {
    const double inv_r3 = 1.0 / (r * r * r);
    return {-0.375 * inv_r3, 1.125 * inv_r3};
  }
  const double a3 = ai * ai * ai * aj * aj * aj, greater = std::fmax(ai, aj);
  if (r <= between) return {0.75 / (greater * greater * greater), 0.0};
  const double d = between / r, d2 = d * d, r3 = r * r * r,
               cross = ai * ai + 4.0 * ai * aj + aj * aj;
  const double squares = ai * ai + aj * aj, cubes = ai * ai * ai + aj * aj * aj;
  const double scale = 0.75 / (64.0 * a3);
  const double transverse =
      5.0 * r3 - 27.0 * r * squares + 32.0 * cubes - 9.0 * r * d2 * sum * sum - r * d2 * d2 * cross;
  return {scale * transverse, 3.0 * scale * r * (1.0 - d2) * (1.0 - d2) * (cross - r * r)};
}

}    // namespace bdh
#endif
