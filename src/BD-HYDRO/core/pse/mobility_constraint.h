// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Given motions of particles whose mobility is that of positively split Ewald.
#ifndef BDH_PSE_MOBILITY_CONSTRAINT_H
#define BDH_PSE_MOBILITY_CONSTRAINT_H

#include "base/constants.h"
#include "base/constraint.h"
#include "pse/mobility.h"

namespace bdh {

/// The residual of a constraint as a share of the tolerance: it adds to the errors of the mobility.
constexpr double constraint_share = 0.3;

/// Loads and motions as a mobility takes them.
template <class Vector> PseForces loads_of(const MomentVectors<Vector> &m)
{
  return {m.linear.data(), true, m.angular.size() ? m.angular.data() : nullptr,
          m.strain.size() ? m.strain.data() : nullptr};
}
template <class Vector> PseVelocities motions_of(MomentVectors<Vector> &m)
{
  return {m.linear.data(), m.angular.data(), m.strain.data()};
}

struct PseConstraintLimits {
  double tolerance;    ///< of the given motions, relative to their change
  double viscosity;
  int iterations;
};

template <class Execution, class Neighbors> class PseConstraintSolver
    : public ConstraintSolver<Execution> {
 public:
  using Base = ConstraintSolver<Execution>;
  using Base::Base;
  using typename Base::Moved;
  using typename Base::Sum;

  /// What there is to solve.  M is bound to the particles.
  static ConstraintProblem problem(PseMobility<Neighbors> &M,
                                   const PseParticles<Neighbors> &particles,
                                   const Constraint &constraint, const PseConstraintLimits &limits)
  {
    ConstraintProblem problem;
    problem.given = constraint;
    problem.moments = M.plan().moments();
    problem.particles = particles.count;
    problem.root = {particles.radius};
    problem.mobility = 1.0 / (6.0 * pi * limits.viscosity);
    problem.tolerance = limits.tolerance;
    problem.least_eigenvalue = 0.1 * M.plan().tolerance;
    problem.limit = limits.iterations;
    return problem;
  }
  /// Collective.  M keeps its pairs.  For the rest, see the base class.
  ConstraintReport solve(const ConstraintProblem &problem, PseMobility<Neighbors> &M,
                         const Sum &sum, Moved &motion)
  {
    const auto mobility = [&M](const Moved &loads, Moved &motions) {
      M.apply(loads_of(loads), motions_of(motions));
    };
    if (problem.given.held) return Base::solve(problem, mobility, sum, motion);
    const auto strains = [&M](const Moved &loads, Moved &motions) {
      M.apply_stresslets(loads_of(loads), motions_of(motions));
    };
    return Base::solve(problem, mobility, sum, motion, {}, strains);
  }
  /// The same for the loads alone; `motion` is arbitrary afterwards.
  ConstraintReport solve_for_loads(const ConstraintProblem &problem, PseMobility<Neighbors> &M,
                                   const Sum &sum, Moved &motion)
  {
    if (problem.given.held) return solve(problem, M, sum, motion);
    const auto strains = [&M](const Moved &loads, Moved &motions) {
      M.apply_stresslets(loads_of(loads), motions_of(motions));
    };
    return Base::solve(problem, {}, sum, motion, {}, strains);
  }
};

}    // namespace bdh
#endif
