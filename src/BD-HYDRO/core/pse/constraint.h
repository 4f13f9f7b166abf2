// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Motions of particles of which some are given, such as those of rigid spheres in a flow, or of
/// particles that are held.
///
/// With the unknown loads c, and the motions V_c that are given,
///
///     M_cc c = V_c - M_cf f - psi_c,   V = M f + M c + psi,
///
/// where f are the known loads and psi a slip.  If the slip has the covariance 2 kT M/dt, the free
/// motions have that of the Schur complement of M_cc, whose root is never needed.
/// See FIB App. B; Fiore, Swan, J. Chem. Phys. 148, 044114 (2018).
#ifndef BDH_PSE_CONSTRAINT_H
#define BDH_PSE_CONSTRAINT_H

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/ssize.h"
#include "pse/constraint_kernel.h"
#include "pse/mobility.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bdh {

/// Loads of particles, or their motions.
template <class Vector> struct MomentVectors {
  Vector linear, angular, strain;

  void resize(long particles, Moments moments)
  {
    linear.resize(dof * particles);
    angular.resize(moments == Moments::none ? 0 : dof * particles);
    strain.resize(moments == Moments::stresslet ? strain_numbers * particles : 0);
  }
  PseForces loads() const
  {
    return {linear.data(), true, angular.size() ? angular.data() : nullptr,
            strain.size() ? strain.data() : nullptr};
  }
  PseVelocities motions() { return {linear.data(), angular.data(), strain.data()}; }
  MomentArrays<double> arrays() { return {linear.data(), angular.data(), strain.data()}; }
  MomentArrays<const double> numbers() const
  {
    return {linear.data(), angular.data(), strain.data()};
  }
  std::size_t memory() const { return bytes_of(linear, angular, strain); }
};

/// The residual of a constraint as a share of the tolerance: it adds to the errors of the mobility.
constexpr double constraint_share = 0.3;

struct ConstraintReport {
  int iterations = 0;
  double residual = 0.0;    ///< relative to what the constraint had to make up for
};

/// Conjugate gradients on M_cc, scaled by the free mobilities.  One product with M per iteration
/// gives the motions of all particles as well, so that there is none left at the end.
template <class Execution, class Neighbors> class ConstraintSolver {
 public:
  using Vector = typename Execution::ParticleVector;
  using Moved = MomentVectors<Vector>;
  using Sum = std::function<double(double)>;

  explicit ConstraintSolver(const Execution &execution = Execution()) : execution_(execution) {}

  /// Collective.  M is bound to the particles and keeps their pairs.
  /// \param motion     in: by known loads and slip; out: with that by the unknown loads
  /// \param tolerance  of the given motions, relative to their change
  /// \param sum        the sum of a number over the ranks
  /// Throws NotConverged.
  ConstraintReport solve(PseMobility<Neighbors> &M, const PseParticles<Neighbors> &particles,
                         const Constraint &constraint, double tolerance, int limit, const Sum &sum,
                         Moved &motion)
  {
    const Moments moments = M.plan().moments();
    count_ = particles.count;
    numbers_ = load_numbers(moments);
    constraint_ = constraint;
    root_ = {particles.radius};
    for (Vector *v : {&residual_, &direction_, &product_, &unknown_}) v->resize(numbers_ * count_);
    load_.resize(count_, moments);
    answer_.resize(count_, moments);
    execution_.clear(unknown_);
    each("bdh::residual",
         Residual{constraint, root_, numbers_, motion.numbers(), residual_.data()});
    execution_.scale(1.0, residual_.data(), direction_.data(), ssize(direction_));
    ConstraintReport report;
    double square = sum(dot(residual_, residual_));
    const double first = square;
    double largest = 0.0;
    while (square > tolerance * tolerance * first) {
      if (report.iterations == limit)
        throw NotConverged("the constraint", limit, std::sqrt(square / first), tolerance);
      ++report.iterations;
      apply(M);
      const double curvature = sum(dot(direction_, product_));
      const double eigenvalue = curvature / sum(dot(direction_, direction_));
      largest = std::max(largest, eigenvalue);
      if (!(eigenvalue > 0.1 * M.plan().tolerance * largest))
        throw NotConverged("the constraint has no solution: particles that lie at the same place, "
                           "or nearly so, cannot have the motions that are given");
      const double alpha = square / curvature;
      add(alpha, direction_, unknown_);
      add(-alpha, product_, residual_);
      add_motion_by_load(alpha, motion);
      const double last = square;
      square = sum(dot(residual_, residual_));
      const double beta = square / last;
      execution_.for_each(
          "bdh::direction", ssize(direction_),
          Combine{beta, direction_.data(), 1.0, residual_.data(), direction_.data()});
    }
    report.residual = first > 0.0 ? std::sqrt(square / first) : 0.0;
    each("bdh::unknown_loads", UnscaledLoads{root_, numbers_, unknown_.data(), load_.arrays()});
    return report;
  }

  /// The unknown loads, found by the last solve().
  const Moved &loads() const { return load_; }

  std::size_t memory() const
  {
    return bytes_of(residual_, direction_, product_, unknown_) + load_.memory() + answer_.memory();
  }

 private:
  template <class Action> void each(const char *name, const Action &action) const
  {
    execution_.for_each(name, count_, action);
  }
  double dot(const Vector &a, const Vector &b) const
  {
    return execution_.dot(a.data(), b.data(), ssize(a));
  }
  void add(double c, const Vector &from, Vector &to) const
  {
    execution_.for_each("bdh::add_scaled", ssize(to), AddScaledNumber{c, from.data(), to.data()});
  }
  /// product_ := M_cc direction_, and answer_ the motions of everything by it.
  void apply(PseMobility<Neighbors> &M)
  {
    each("bdh::loads", UnscaledLoads{root_, numbers_, direction_.data(), load_.arrays()});
    M.apply(load_.loads(), answer_.motions());
    each("bdh::given_motions",
         GivenMotions{constraint_, root_, numbers_, answer_.numbers(), product_.data()});
  }
  void add_motion_by_load(double alpha, Moved &motion) const
  {
    add(alpha, answer_.linear, motion.linear);
    add(alpha, answer_.angular, motion.angular);
    add(alpha, answer_.strain, motion.strain);
  }

  Execution execution_;
  long count_ = 0;
  int numbers_ = dof;
  Constraint constraint_;
  LoadRoots root_{nullptr};
  Vector residual_, direction_, product_, unknown_;    // numbers_ per particle
  Moved load_, answer_;
};

}    // namespace bdh
#endif
