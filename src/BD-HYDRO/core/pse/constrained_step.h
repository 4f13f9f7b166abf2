// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Time steps of Brownian dynamics of which some motions are given: rigid spheres in a flow, and
/// particles that are held.
#ifndef BDH_PSE_CONSTRAINED_STEP_H
#define BDH_PSE_CONSTRAINED_STEP_H

#include "base/noise_loads.h"
#include "pse/mobility_constraint.h"
#include "pse/step.h"

namespace bdh {

/// One step, with the slip psi of covariance 2 kT M/dt drawn at x,
///
///     x* = x + dt/2 psi_U,   V = M(x*) f + M(x*) c + psi,   x' = x + dt V.
///
/// The same slip in a predictor without the constraint makes the thermal drift kT div of the
/// constrained mobility, since the mobility itself has no divergence: div R = -d/dx_j (M_fc
/// M_cc^-1) M_c,xj.  A predictor that moves with the constrained velocity gives none.
template <class Execution, class Neighbors> class ConstrainedStep
    : public PseStep<Execution, Neighbors> {
 public:
  using Base = PseStep<Execution, Neighbors>;
  using typename Base::Mobility;
  using typename Base::Particles;
  using typename Base::Surroundings;
  using typename Base::Vector;
  using Moved = MomentVectors<Vector>;

  explicit ConstrainedStep(const Execution &execution = Execution()) :
      Base(execution), solver_(execution), noise_loads_(execution)
  {}

  /// Collective.  Where velocities of held particles are given, `constraint` has them.  Throws
  /// BadParticle and NotConverged.
  PseReport take(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan,
                 const Constraint &constraint)
  {
    M.set_viscosity(plan.viscosity);
    this->turn_ = plan.rotation;
    const Moments moments = M.plan().moments();
    const PseForces forces = this->look_and_bind(p, around, M);
    for (Moved *m : {&motion_, &slip_, &known_}) m->resize(p.size(), moments);
    execution().clear(known_.strain);
    known(p, constraint, forces.values, known_.linear);
    if (moments != Moments::none) known(p, constraint, forces.torques, known_.angular);
    const auto sum = [&around](double mine) { return around.sum(mine); };
    const PseConstraintLimits limits{constraint_share * M.plan().tolerance, plan.viscosity,
                                     plan.constraint_limit};
    PseReport report;
    noise_loads_.forget();
    PseParticles<Neighbors> where = particles_among(p, around);
    const PseNoise noise = plan.noise();
    if (noise.acts()) {
      report = M.fluctuate({}, noise, motions_of(slip_));
      if (plan.noise_loads)
        report.constraint_iterations = find_noise_loads(M, where, constraint, limits, sum);
      where = midway(p, around, constraint, plan.dt, where);
      M.bind(where);
    }
    M.keep_pairs();
    const ConstraintProblem problem = solver_.problem(M, where, constraint, limits);
    if (!noise.acts()) clear(slip_);
    const bool guessed = solver_.guess(problem, sum, slip_);
    if (guessed) add(solver_.loads(), known_);
    PseForces loads = loads_of(known_);
    loads.act = forces.act || guessed;
    M.apply(loads, motions_of(motion_));
    if (noise.acts()) add(slip_, motion_);
    report.constraint_iterations += solver_.solve(problem, M, sum, motion_).iterations;
    if (noise_loads_.kept()) noise_loads_.take_from(solver_.loads());
    move(p, constraint, plan);
    return report;
  }

  static std::vector<double> to_host(const Vector &v) { return Execution::to_host(v); }
  /// The unknown loads of the last step: forces and torques on the fluid of those held, stresslets;
  /// without the noise in them if the plan asked for that.
  const Moved &loads() const { return noise_loads_.kept() ? noise_loads_.rest() : solver_.loads(); }
  /// Angular velocities of the last step, relative to the flow; empty without rotation.
  const Vector &angular() const { return motion_.angular; }

  std::size_t memory() const
  {
    return Base::memory() + solver_.memory() + noise_loads_.memory() + motion_.memory() +
           slip_.memory() + known_.memory() + bytes_of(shift_, midway_);
  }

 private:
  const Execution &execution() const { return this->execution_; }

  void known(const Particles &p, const Constraint &constraint, const double *from, Vector &to) const
  {
    execution().for_each("bdh::known_loads", p.size(), KnownLoads{constraint, from, to.data()});
  }
  /// Keeps the loads that the slip alone causes at x, where M is bound.  Returns iterations.
  template <class Sum> int find_noise_loads(Mobility &M, const PseParticles<Neighbors> &where,
                                            const Constraint &constraint,
                                            PseConstraintLimits limits, const Sum &sum)
  {
    limits.tolerance = std::max(limits.tolerance, noise_loads_tolerance);
    const ConstraintProblem problem = solver_.problem(M, where, at_rest(constraint), limits);
    M.keep_pairs();
    clear(motion_);
    add(slip_, motion_);
    const int iterations = solver_.solve_for_loads(problem, M, sum, motion_).iterations;
    noise_loads_.keep(solver_.loads(), where.count, problem.moments);
    return iterations;
  }
  /// The particles at x + dt/2 psi_U.
  PseParticles<Neighbors> midway(const Particles &p, Surroundings &around,
                                 const Constraint &constraint, double dt,
                                 PseParticles<Neighbors> where)
  {
    shift_.resize(dof * p.size());
    midway_.resize(dof * p.size());
    execution().for_each("bdh::midway", p.size(),
                         MoveFree{constraint, 0.5 * dt, slip_.linear.data(), shift_.data()});
    execution().for_each("bdh::midway", ssize(midway_),
                         Combine{1.0, p.x(), 1.0, shift_.data(), midway_.data()});
    where.x = midway_.data();
    where.neighbors = around.shifted(shift_.data());
    return where;
  }
  void clear(Moved &m)
  {
    for (Vector *v : {&m.linear, &m.angular, &m.strain}) execution().clear(*v);
  }
  void add(const Moved &from, Moved &to)
  {
    const auto add = [this](const Vector &part, Vector &sum) {
      execution().for_each("bdh::add_moments", ssize(sum),
                           AddScaledNumber{1.0, part.data(), sum.data()});
    };
    add(from.linear, to.linear);
    add(from.angular, to.angular);
    add(from.strain, to.strain);
  }
  void move(Particles &p, const Constraint &constraint, const PseStepPlan &plan)
  {
    const auto set = [&](const double *given, Vector &v) {
      execution().for_each("bdh::held", p.size(), SetHeld{constraint, given, v.data()});
    };
    set(constraint.velocity, motion_.linear);
    if (motion_.angular.size()) set(constraint.angular, motion_.angular);
    this->sized(this->velocity_, p);
    scale(execution(), 1.0, motion_.linear, this->velocity_.linear);
    if (this->turn_) scale(execution(), 1.0, motion_.angular, this->velocity_.angular);
    this->finish(p, plan);
  }

  PseConstraintSolver<Execution, Neighbors> solver_;
  NoiseLoads<Execution> noise_loads_;
  Moved motion_, slip_, known_;
  Vector shift_, midway_;
};

}    // namespace bdh
#endif
