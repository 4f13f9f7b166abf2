// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a constraint: which motions of a particle are given, and the scaled
/// numbers of its unknown loads.
#ifndef BDH_PSE_CONSTRAINT_KERNEL_H
#define BDH_PSE_CONSTRAINT_KERNEL_H

#include "base/strain_kernel.h"
#include "pse/layout.h"
#include "pse/step_kernel.h"

namespace bdh {

/// What is given of the motion of particles, in the memory of the execution.
///
/// A particle that is held has a given velocity and, where particles rotate, a given angular
/// velocity; a rigid one does not strain.  The loads that see to this are unknown.
struct Constraint {
  bool rigid = false;    ///< rates of strain are given: minus that of the flow
  /// The flow's rate of strain, in its strain_numbers [1/time].
  double flow[strain_numbers] = {0.0, 0.0, 0.0, 0.0, 0.0};
  const char *held = nullptr;          ///< by particle; null: none is held
  const double *velocity = nullptr;    ///< of those held, dof per particle [length/time]
  const double *angular = nullptr;     ///< likewise [1/time]; null: 0

  BDH_FN bool holds(long p) const { return held && held[p]; }
};

/// Numbers of a particle in the vectors of a constraint: of its force, its torque, its stresslet.
BDH_FN constexpr int load_numbers(Moments moments)
{
  return moments == Moments::none     ? dim
         : moments == Moments::torque ? 2 * dim
                                      : 2 * dim + strain_numbers;
}

/// Loads or motions: 3, 3 and 5 numbers per particle.
template <class Number> struct MomentArrays {
  Number *linear, *angular, *strain;
  /// Number c of a particle.
  BDH_FN Number &at(long p, int c) const
  {
    return c < dim       ? linear[dim * p + c]
           : c < 2 * dim ? angular[dim * p + c - dim]
                         : strain[strain_numbers * p + c - 2 * dim];
  }
};

/// The roots of the free mobilities, which scale vectors; radius may be null if all are equal.
struct LoadRoots {
  const double *radius;
  BDH_FN double at(long p, int c) const
  {
    if (!radius) return 1.0;
    const FreeRoots root{radius};
    return c < dim ? root.force(p) : c < 2 * dim ? root.torque(p) : root.stresslet(p);
  }
};

BDH_FN bool is_given(const Constraint &constraint, long p, int c)
{
  return c < 2 * dim ? constraint.holds(p) : constraint.rigid;
}

/// residual := what the given motions lack, over the roots, and 0 for what is free; by particle.
struct Residual {
  Constraint constraint;
  LoadRoots root;
  int numbers;
  MomentArrays<const double> motion;
  double *residual;
  BDH_FN double target(long p, int c) const
  {
    if (c < dim) return constraint.velocity ? constraint.velocity[dim * p + c] : 0.0;
    if (c < 2 * dim) return constraint.angular ? constraint.angular[dim * p + c - dim] : 0.0;
    return -constraint.flow[c - 2 * dim];
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
  LoadRoots root;
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
  LoadRoots root;
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
  const double *from;    // dof per particle; null: 0
  double *load;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dof; ++c)
      load[dof * p + c] = from && !constraint.holds(p) ? from[dof * p + c] : 0.0;
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
    for (int c = 0; c < dof; ++c)
      displacement[dof * p + c] = constraint.holds(p) ? 0.0 : factor * velocity[dof * p + c];
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
      for (int c = 0; c < dof; ++c) v[dof * p + c] = given ? given[dof * p + c] : 0.0;
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
