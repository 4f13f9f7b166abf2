// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Rotations by rotation vectors: along the axis, as long as the angle [radians].
///
/// They act by the exponential map, exactly for any angle, and keep lengths.  The noise of a step
/// turns a particle by a vector of normals of covariance 2 kT M dt.  The exponential of such a
/// vector has the mean of the second order that the diffusion of orientations requires, so that no
/// drift is added.   [Delong, Balboa Usabiaga & Donev, J. Chem. Phys. 143, 144107 (2015)]
#ifndef BDH_BASE_ROTATION_KERNEL_H
#define BDH_BASE_ROTATION_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// A rotation as a unit quaternion (w, x, y, z).
struct Turn {
  double w, v[3];

  /// By the rotation vector r.
  BDH_FN static Turn by(const double *r)
  {
    const double angle = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    const double s = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
    return {std::cos(0.5 * angle), {s * r[0], s * r[1], s * r[2]}};
  }
  /// First `a`, then `b`.
  BDH_FN static Turn both(const Turn &a, const Turn &b)
  {
    const double *p = b.v, *q = a.v;
    return {a.w * b.w - (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]),
            {b.w * q[0] + a.w * p[0] + p[1] * q[2] - p[2] * q[1],
             b.w * q[1] + a.w * p[1] + p[2] * q[0] - p[0] * q[2],
             b.w * q[2] + a.w * p[2] + p[0] * q[1] - p[1] * q[0]}};
  }
  /// r := the rotation vector, of an angle of at most pi.
  BDH_FN void vector(double *r) const
  {
    const double sine = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double sign = w < 0.0 ? -1.0 : 1.0;
    const double s = sine > 0.0 ? sign * 2.0 * std::atan2(sine, sign * w) / sine : 2.0 * sign;
    for (int d = 0; d < 3; ++d) r[d] = s * v[d];
  }
};

/// r := the rotation vector of the rotation by r, followed by that by factor times r2.
BDH_FN void turn_further(double factor, const double *r2, double *r)
{
  const double turn[3] = {factor * r2[0], factor * r2[1], factor * r2[2]};
  Turn::both(Turn::by(r), Turn::by(turn)).vector(r);
}

/// Turns the vector u and gives it exactly the length `length`, which it has but for rounding.
BDH_FN void turn_vector(const Turn &turn, double length, double *u)
{
  const double *v = turn.v;
  const double t[3] = {2.0 * (v[1] * u[2] - v[2] * u[1]), 2.0 * (v[2] * u[0] - v[0] * u[2]),
                       2.0 * (v[0] * u[1] - v[1] * u[0])};
  const double turned[3] = {u[0] + turn.w * t[0] + v[1] * t[2] - v[2] * t[1],
                            u[1] + turn.w * t[1] + v[2] * t[0] - v[0] * t[2],
                            u[2] + turn.w * t[2] + v[0] * t[1] - v[1] * t[0]};
  const double size =
      std::sqrt(turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2]);
  const double scale = size > 0.0 ? length / size : 0.0;
  for (int d = 0; d < 3; ++d) u[d] = scale * turned[d];
}

/// Turns a body whose orientation is the unit quaternion q = (w, x, y, z).
BDH_FN void turn_quaternion(const Turn &turn, double *q)
{
  const Turn now = Turn::both({q[0], {q[1], q[2], q[3]}}, turn);
  const double *v = now.v;
  const double scale = 1.0 / std::sqrt(now.w * now.w + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  q[0] = scale * now.w;
  for (int d = 0; d < 3; ++d) q[d + 1] = scale * v[d];
}

/// turned := the rotation by it, followed by that of an angular velocity in a time, by particle: 3
/// numbers each.
struct AddTurn {
  double time;
  const double *angular_velocity;
  double *turned;
  BDH_FN void operator()(long i) const
  {
    turn_further(time, angular_velocity + 3 * i, turned + 3 * i);
  }
};

/// left := what is left to do of the rotation `whole` after `done`, by particle: 3 numbers each.
struct RestOfTurn {
  const double *whole, *done;
  double *left;
  BDH_FN void operator()(long i) const
  {
    const double back[3] = {-done[3 * i], -done[3 * i + 1], -done[3 * i + 2]};
    Turn::both(Turn::by(back), Turn::by(whole + 3 * i)).vector(left + 3 * i);
  }
};

}    // namespace bdh
#endif
