// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Loads of a particle, or its motions: a force, a torque, a stresslet; a velocity, an angular
/// velocity, a rate of strain.
#ifndef BDH_BASE_MOMENTS_KERNEL_H
#define BDH_BASE_MOMENTS_KERNEL_H

#include "base/portable.h"
#include "base/strain_kernel.h"

#include <cmath>

namespace bdh {

/// What a sphere has besides a force: nothing, a torque, or a torque and a stresslet.
enum class Moments { none, torque, stresslet };
constexpr Moments moments_of(bool rotation) { return rotation ? Moments::torque : Moments::none; }

/// Numbers of a force or a torque, and of what belongs to them.
constexpr int vector_size = 3;

/// Numbers of a particle's force, torque and stresslet together.
BDH_FN constexpr int load_numbers(Moments moments)
{
  return moments == Moments::none     ? vector_size
         : moments == Moments::torque ? 2 * vector_size
                                      : 2 * vector_size + strain_numbers;
}

/// Loads or motions: 3, 3 and 5 numbers per particle.
template <class Number> struct MomentArrays {
  Number *linear, *angular, *strain;
  /// Number c of a particle.
  BDH_FN Number &at(long p, int c) const
  {
    return c < vector_size       ? linear[vector_size * p + c]
           : c < 2 * vector_size ? angular[vector_size * p + c - vector_size]
                                 : strain[strain_numbers * p + c - 2 * vector_size];
  }
};

/// The roots of the free mobilities of spheres of radius a, in units of 1/(6 pi viscosity): those
/// of force, torque and stresslet are 1/a, 3/(4 a^3) and 9/(10 a^3).
struct FreeRoots {
  const double *radius;    ///< by particle; null: all are equal
  double equal = 1.0;      ///< this radius
  BDH_FN double of(long p) const { return radius ? radius[p] : equal; }
  BDH_FN double force(long p) const { return 1.0 / std::sqrt(of(p)); }
  BDH_FN double torque(long p) const { return std::sqrt(0.75 / (of(p) * of(p) * of(p))); }
  BDH_FN double stresslet(long p) const { return std::sqrt(0.9 / (of(p) * of(p) * of(p))); }
  /// Of number c of a particle.
  BDH_FN double at(long p, int c) const
  {
    return c < vector_size ? force(p) : c < 2 * vector_size ? torque(p) : stresslet(p);
  }
};

}    // namespace bdh
#endif
