// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a constraint: which motions of a particle are given, and the scaled
/// numbers of its unknown loads.
#ifndef BDH_BASE_CONSTRAINT_KERNEL_H
#define BDH_BASE_CONSTRAINT_KERNEL_H

#include "base/moments_kernel.h"

namespace bdh {

/// What is given of the motion of particles, in the memory of the execution.
///
/// A particle that is held has a given velocity and, where particles rotate, a given angular
/// velocity; a rigid one does not strain.  The loads that see to this are unknown.
struct Constraint {
  bool rigid = false;    ///< rates of strain are given: minus that of the flow
  /// The flow's rate of strain, in its strain_numbers [1/time].
  double flow[strain_numbers] = {0.0, 0.0, 0.0, 0.0, 0.0};
  /// By particle; null if none is held, on any rank.
  const char *held = nullptr;
  const double *velocity = nullptr;    ///< of those held, vector_size per particle [length/time]
  const double *angular = nullptr;     ///< likewise [1/time]; null: 0

  BDH_FN bool holds(long p) const { return held && held[p]; }
};

/// The same particles, with motions of 0.
inline Constraint at_rest(Constraint constraint)
{
  constraint.velocity = constraint.angular = nullptr;
  for (double &rate : constraint.flow) rate = 0.0;
  return constraint;
}

BDH_FN bool is_given(const Constraint &constraint, long p, int c)
{
  return c < 2 * vector_size ? constraint.holds(p) : constraint.rigid;
}

/// residual := what the given motions lack, over the roots, and 0 for what is free; by particle.
struct Residual {
  Constraint constraint;
  FreeRoots root;
  int numbers;
  MomentArrays<const double> motion;
  double *residual;
  BDH_FN double target(long p, int c) const
  {
    if (c < vector_size)
      return constraint.velocity ? constraint.velocity[vector_size * p + c] : 0.0;
    if (c < 2 * vector_size)
      return constraint.angular ? constraint.angular[vector_size * p + c - vector_size] : 0.0;
    return -constraint.flow[c - 2 * vector_size];
  }
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < numbers; ++c)
      residual[numbers * p + c] =
          is_given(constraint, p, c) ? (target(p, c) - motion.at(p, c)) / root.at(p, c) : 0.0;
  }
};
/// product := the given motions over the roots, and 0 for what is free; by particle.
struct GivenMotions {
  Constraint constraint;
  FreeRoots root;
  int numbers;
  MomentArrays<const double> motion;
  double *product;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < numbers; ++c)
      product[numbers * p + c] = is_given(constraint, p, c) ? motion.at(p, c) / root.at(p, c) : 0.0;
  }
};
/// load := a scaled vector over the roots; by particle.
struct UnscaledLoads {
  FreeRoots root;
  int numbers;
  const double *from;
  MomentArrays<double> load;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < numbers; ++c) load.at(p, c) = from[numbers * p + c] / root.at(p, c);
  }
};
/// load := the given one, and 0 where a particle is held: its load is unknown; by particle.
struct KnownLoads {
  Constraint constraint;
  const double *from;    // vector_size per particle; null: 0
  double *load;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < vector_size; ++c)
      load[vector_size * p + c] = from && !constraint.holds(p) ? from[vector_size * p + c] : 0.0;
  }
};
/// energy := kT, and 0 where a particle is held, for each component; by particle.
struct FreeEnergies {
  Constraint constraint;
  double kT;
  double *energy;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < vector_size; ++c)
      energy[vector_size * p + c] = constraint.holds(p) ? 0.0 : kT;
  }
};
/// strain += that of a flow, by particle.
struct AddStrain {
  double flow[strain_numbers];
  double *strain;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < strain_numbers; ++c) strain[strain_numbers * p + c] += flow[c];
  }
};
/// displacement := factor times the velocity, and 0 where a particle is held; by particle.
struct MoveFree {
  Constraint constraint;
  double factor;
  const double *velocity;
  double *displacement;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < vector_size; ++c)
      displacement[vector_size * p + c] =
          constraint.holds(p) ? 0.0 : factor * velocity[vector_size * p + c];
  }
};
/// v := the given velocity of those that are held; by particle.
struct SetHeld {
  Constraint constraint;
  const double *given;    // null: 0
  double *v;
  BDH_FN void operator()(long p) const
  {
    if (constraint.holds(p))
      for (int c = 0; c < vector_size; ++c)
        v[vector_size * p + c] = given ? given[vector_size * p + c] : 0.0;
  }
};
/// to += c from
struct AddScaledNumber {
  double c;
  const double *from;
  double *to;
  BDH_FN void operator()(long k) const { to[k] += c * from[k]; }
};

}    // namespace bdh
#endif
