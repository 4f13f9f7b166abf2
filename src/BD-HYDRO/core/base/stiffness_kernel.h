// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How stiff the forces on particles are for a time step, from forces and displacements alone.
///
/// A force -k q that acts for a time dt on a particle of mobility mu moves it by p = dt mu k times
/// its distance from equilibrium.  Euler-Maruyama steps give distances the variance kT/k times
/// 1/(1 - p/2), and are unstable from p = 2 on.  For displacements dq and the changes dF of forces
/// that they bring about, k = |dF|^2/|dF.dq|; summed over both particles of a pair this is the
/// stiffness of their distance, 2 k, which belongs to the mobility mu of each.
#ifndef BDH_BASE_STIFFNESS_KERNEL_H
#define BDH_BASE_STIFFNESS_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// What turns a stiffness into a number p.
struct StiffnessScale {
  double time = 0.0;        ///< of the displacements [time]
  double piece = 0.0;       ///< for which forces act before they are computed again [time]
  double mobility = 0.0;    ///< of a particle alone; where radii are given, times its radius
  double kT = 0.0;          ///< [energy]
};

/// A step of all particles: arrays of 3 numbers each.
struct StiffnessOf {
  StiffnessScale scale;
  const double *before, *after;    ///< forces
  const double *velocity;          ///< displacement/time
  const double *radius;            ///< one number each, or null

  BDH_FN double mobility(long i) const
  {
    return radius ? scale.mobility / radius[i] : scale.mobility;
  }
  BDH_FN double change2(long i) const
  {
    double sum = 0.0;
    for (long k = 3 * i; k < 3 * i + 3; ++k) sum += (after[k] - before[k]) * (after[k] - before[k]);
    return sum;
  }
  BDH_FN double moved2(long i) const
  {
    double sum = 0.0;
    for (long k = 3 * i; k < 3 * i + 3; ++k) sum += velocity[k] * velocity[k];
    return scale.time * scale.time * sum;
  }
  /// dF.dq
  BDH_FN double work(long i) const
  {
    double sum = 0.0;
    for (long k = 3 * i; k < 3 * i + 3; ++k) sum += (after[k] - before[k]) * velocity[k];
    return scale.time * sum;
  }
  /// dt mu |dF|^2
  BDH_FN double reaction(long i) const { return scale.piece * mobility(i) * change2(i); }
  /// The number p of one particle.  A particle may happen to move little along dF while its
  /// partner moves a lot; so as not to divide by that, the displacement along dF counts as what it
  /// is on average if it is less.
  BDH_FN double number(long i) const
  {
    const double change = std::sqrt(change2(i));
    if (!(change > 0.0)) return 0.0;
    const double along = std::fabs(work(i)) / change;
    const double random = 2.0 * scale.kT * mobility(i) * scale.time, third = moved2(i) / 3.0;
    const double usual = std::sqrt(random > third ? random : third);
    const double moved = along > usual ? along : usual;
    return moved > 0.0 ? scale.piece * mobility(i) * change / moved : 0.0;
  }
};

/// Terms of sums over particles.
struct Reaction {
  StiffnessOf of;
  BDH_FN double operator()(long i) const { return of.reaction(i); }
};
struct WorkOfChange {
  StiffnessOf of;
  BDH_FN double operator()(long i) const { return of.work(i); }
};
struct ChangeOfForce {
  StiffnessOf of;
  BDH_FN double operator()(long i) const { return std::sqrt(of.change2(i)); }
};
struct StiffnessNumber {
  StiffnessOf of;
  BDH_FN double operator()(long i) const { return of.number(i); }
};
/// True for a particle whose number p reaches a bound.
struct IsAsStiffAs {
  StiffnessOf of;
  double bound;
  BDH_FN bool operator()(long i) const { return of.number(i) >= bound; }
};

}    // namespace bdh
#endif
