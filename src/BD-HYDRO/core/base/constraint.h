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
#ifndef BDH_BASE_CONSTRAINT_H
#define BDH_BASE_CONSTRAINT_H

#include "base/bytes_of.h"
#include "base/constraint_kernel.h"
#include "base/errors.h"
#include "base/ssize.h"
#include "base/vector_kernel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace bdh {

/// Loads of particles, or their motions.
template <class Vector> struct MomentVectors {
  Vector linear, angular, strain;

  void resize(long particles, Moments moments)
  {
    linear.resize(vector_size * particles);
    angular.resize(moments == Moments::none ? 0 : vector_size * particles);
    strain.resize(moments == Moments::stresslet ? strain_numbers * particles : 0);
  }
  MomentArrays<double> arrays() { return {linear.data(), angular.data(), strain.data()}; }
  MomentArrays<const double> numbers() const
  {
    return {linear.data(), angular.data(), strain.data()};
  }
  std::size_t memory() const { return bytes_of(linear, angular, strain); }
};

/// Motions of particles of which some are given, to some tolerance.
struct ConstraintProblem {
  Constraint given;
  Moments moments = Moments::none;
  long particles = 0;
  FreeRoots root{nullptr};
  double tolerance = 0.0;    ///< of the given motions, relative to their change
  /// 1/(6 pi viscosity), for guess(): the unit of the free mobilities whose roots are `root`.
  double mobility = 0.0;
  /// Of M_cc in units of the free mobilities, relative to the greatest one that was met.  What is
  /// less has no solution.
  double least_eigenvalue = 0.0;
  int limit = 0;    ///< iterations
};

struct ConstraintReport {
  int iterations = 0;
  double residual = 0.0;    ///< relative to what the constraint had to make up for
};

/// Conjugate gradients on M_cc, scaled by the free mobilities.  One product with M per iteration
/// gives the motions of all particles as well, so that there is none left at the end, unless there
/// is a cheaper product for the given motions alone.
template <class Execution> class ConstraintSolver {
 public:
  using Vector = typename Execution::ParticleVector;
  using Moved = MomentVectors<Vector>;
  using Sum = std::function<double(double)>;
  /// M: motions := those by these loads.
  using Mobility = std::function<void(const Moved &loads, Moved &motions)>;
  /// Called after each iteration: the last product of M, times `share`, has been added.
  using Added = std::function<void(double share)>;

  explicit ConstraintSolver(const Execution &execution = Execution()) : execution_(execution) {}

  /// Collective.  loads() := those that would give the motions to particles that are alone.  The
  /// next solve() starts from them, and they belong to the known loads of its `motion`: this saves
  /// an iteration, since slips do most of what a constraint has to make up for.
  /// \param motion     by the slip
  /// Returns whether any of these loads acts.
  bool guess(const ConstraintProblem &problem, const Sum &sum, const Moved &motion)
  {
    begin(problem, motion);
    guessed_ = sum(dot(residual_, residual_));
    guess_.resize(residual_.size());
    execution_.scale(1.0 / problem.mobility, residual_.data(), guess_.data(), ssize(guess_));
    unscale(guess_);
    return guessed_ > 0.0;
  }

  /// Collective.
  /// \param motion     in: by known loads and slip; out: with that by the unknown loads
  /// \param sum        the sum of a number over the ranks
  /// \param M_cc       if there is one: like M, for the given motions alone.  Without M only the
  ///                   loads are found, and `motion` stays as it is.
  /// Throws NotConverged.
  ConstraintReport solve(const ConstraintProblem &problem, const Mobility &M, const Sum &sum,
                         Moved &motion, const Added &added = {}, const Mobility &M_cc = {})
  {
    begin(problem, motion);
    const double guessed = std::exchange(guessed_, 0.0);    // even if this does not converge
    ConstraintReport report;
    double square = sum(dot(residual_, residual_));
    const double first = std::max(square, guessed);
    double largest = 0.0;
    while (square > problem.tolerance * problem.tolerance * first) {
      if (report.iterations == problem.limit)
        throw NotConverged("the constraint", problem.limit, std::sqrt(square / first),
                           problem.tolerance);
      ++report.iterations;
      apply(M_cc ? M_cc : M);
      const double curvature = sum(dot(direction_, product_));
      const double eigenvalue = curvature / sum(dot(direction_, direction_));
      largest = std::max(largest, eigenvalue);
      if (!(eigenvalue > problem.least_eigenvalue * largest))
        throw NotConverged("the constraint has no solution: particles that lie at the same place, "
                           "or nearly so, cannot have the motions that are given");
      const double alpha = square / curvature;
      add(alpha, direction_, unknown_);
      add(-alpha, product_, residual_);
      if (!M_cc) {
        add_motion_by_load(alpha, motion);
        if (added) added(alpha);
      }
      const double last = square;
      square = sum(dot(residual_, residual_));
      turn_direction(square / last);
    }
    report.residual = first > 0.0 ? std::sqrt(square / first) : 0.0;
    if (M_cc && M && report.iterations) {
      unscale(unknown_);
      M(load_, answer_);
      add_motion_by_load(1.0, motion);
      if (added) added(1.0);
    }
    if (guessed > 0.0) add(1.0, guess_, unknown_);
    unscale(unknown_);
    return report;
  }

  /// The unknown loads, found by the last solve().
  const Moved &loads() const { return load_; }

  std::size_t memory() const
  {
    return bytes_of(residual_, direction_, product_, unknown_, guess_) + load_.memory() +
           answer_.memory();
  }

 private:
  template <class Action> void each(const char *name, const Action &action) const
  {
    execution_.for_each(name, problem_.particles, action);
  }
  double dot(const Vector &a, const Vector &b) const
  {
    return execution_.dot(a.data(), b.data(), ssize(a));
  }
  void add(double c, const Vector &from, Vector &to) const
  {
    execution_.for_each("bdh::add_scaled", ssize(to), AddScaledNumber{c, from.data(), to.data()});
  }
  /// Unknown loads := 0; the residual and the first direction := what the motion lacks.
  void begin(const ConstraintProblem &problem, const Moved &motion)
  {
    problem_ = problem;
    numbers_ = load_numbers(problem.moments);
    for (Vector *v : {&residual_, &direction_, &product_, &unknown_})
      v->resize(numbers_ * problem.particles);
    load_.resize(problem.particles, problem.moments);
    answer_.resize(problem.particles, problem.moments);
    execution_.clear(unknown_);
    each("bdh::residual",
         Residual{problem.given, problem.root, numbers_, motion.numbers(), residual_.data()});
    execution_.scale(1.0, residual_.data(), direction_.data(), ssize(direction_));
  }
  /// load_ := a scaled vector of loads
  void unscale(const Vector &scaled)
  {
    each("bdh::unscaled_loads",
         UnscaledLoads{problem_.root, numbers_, scaled.data(), load_.arrays()});
  }
  /// product_ := M_cc direction_, and answer_ the motions of everything by it.
  void apply(const Mobility &M)
  {
    unscale(direction_);
    M(load_, answer_);
    each("bdh::given_motions",
         GivenMotions{problem_.given, problem_.root, numbers_, answer_.numbers(), product_.data()});
  }
  void add_motion_by_load(double alpha, Moved &motion) const
  {
    add(alpha, answer_.linear, motion.linear);
    add(alpha, answer_.angular, motion.angular);
    add(alpha, answer_.strain, motion.strain);
  }
  void turn_direction(double beta)
  {
    execution_.for_each("bdh::direction", ssize(direction_),
                        Combine{beta, direction_.data(), 1.0, residual_.data(), direction_.data()});
  }

  Execution execution_;
  ConstraintProblem problem_;
  int numbers_ = vector_size;
  double guessed_ = 0.0;    // square of what the guess made up for; 0: there is none
  Vector residual_, direction_, product_, unknown_, guess_;    // numbers_ per particle
  Moved load_, answer_;
};

}    // namespace bdh
#endif
