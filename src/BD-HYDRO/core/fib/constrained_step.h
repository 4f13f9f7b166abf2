// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Time steps with the fluctuating immersed boundary method of which some motions are given: rigid
/// spheres, and particles that are held.  [FIB App. B]
#ifndef BDH_FIB_CONSTRAINED_STEP_H
#define BDH_FIB_CONSTRAINED_STEP_H

#include "base/constraint.h"
#include "base/noise_loads.h"
#include "fib/step.h"

namespace bdh {

/// What a constraint needs besides the plan of a step.
struct ConstraintPlan {
  Moments moments = Moments::none;    ///< that the fluid spreads
  double radius = 1.0;                ///< hydrodynamic radius, which scales the loads [length]
  double tolerance = 1e-3;            ///< of the given motions
  int limit = 1000;                   ///< iterations
  bool noise_loads = false;           ///< the loads are kept without their noise
};

/// One step of the midpoint scheme, with K the interpolation of all moments and its adjoint S:
///
///     x* = x + dt/2 J v,   v = L^-1 (S f + kT div S) + noise,
///     V = K(x*) v + K(x*) L^-1 S(x*) c,   x' = x + dt V.
///
/// The loads c see to the motions that are given.  With Q = (1, -M_fc M_cc^-1) the free motions are
/// Q K v, and their thermal drift
///
///     kT d/dx_j (Q K L^-1 S_j) = kT (d_j Q) K L^-1 S_j + kT Q (d_j K) L^-1 S_j + kT Q K L^-1 d_j
///     S_j
///
/// has its first two parts from taking Q and K at x*, where the fluid without the constraint has
/// carried the particles, and the third from the force kT div S.  A predictor that moves with the
/// constrained velocity loses the first part.  Nothing is assumed of the divergence of M, which on
/// a grid, or at a wall, is not 0.
template <class Place> class ConstrainedBrownianStep : public BrownianStep<Place> {
 public:
  using Base = BrownianStep<Place>;
  using Fluid = FibFluid<Place>;
  using typename Base::Particles;
  using typename Base::Vector;
  using Execution = typename Place::Execution;
  using Moved = MomentVectors<Vector>;

  explicit ConstrainedBrownianStep(Fluid &fluid) :
      Base(fluid), solver_(fluid.execution()), noise_loads_(fluid.execution())
  {}

  /// Collective.  Where velocities of held particles are given, `constraint` has them.  Throws what
  /// the base class does, and NotConverged.
  void take(Particles &p, const StepPlan &plan, const Constraint &constraint,
            const ConstraintPlan &how)
  {
    this->begin(plan);
    constraint_ = constraint;
    how_ = how;
    while (!one_solve(p)) confinement_.next_attempt(p, x_);
  }

  /// With the forces on walls by all loads of the last step.
  SolveReport report() const { return report_; }
  /// Iterations of the constraint in the last step.
  int iterations() const { return iterations_; }
  /// The unknown loads of the last step: forces and torques on the fluid of those held, stresslets;
  /// without the noise in them if the plan asked for that.
  const Moved &loads() const { return noise_loads_.kept() ? noise_loads_.rest() : solver_.loads(); }
  /// Angular velocities of the last step; empty without torques and stresslets.
  const Vector &angular() const { return motion_.angular; }
  static std::vector<double> to_host(const Vector &v) { return Execution::to_host(v); }

  std::size_t memory() const
  {
    return Base::memory() + solver_.memory() + noise_loads_.memory() + motion_.memory() +
           bytes_of(known_, energy_);
  }

 private:
  using Base::confinement_;
  using Base::fluid_;
  using Base::plan_;
  using Base::u_;
  using Base::v_;
  using Base::x_;

  const Execution &execution() const { return this->execution_; }
  bool turns() const { return how_.moments != Moments::none; }

  bool one_solve(Particles &p)
  {
    this->resize(p.size());
    motion_.resize(p.size(), how_.moments);
    fluid_.bind(p.x(), p.size());
    fluid_.clear();
    iterations_ = 0;
    noise_loads_.forget();
    if (how_.noise_loads && plan_.kT > 0.0) find_noise_loads(p.size());
    spread_known(p);
    fluid_.solve(this->problem({{1.0, 0}}));
    report_ = fluid_.report();
    const double *q = p.x();
    if (plan_.corrector) {
      this->particle_velocity(q, u_);
      execution().for_each("bdh::midway", p.size(),
                           MoveFree{constraint_, 0.5 * plan_.dt, u_.data(), v_.data()});
      combine(execution(), 1.0, q, 1.0, v_.data(), x_);
      if (!confinement_.confine(p, x_)) return false;
      confinement_.require_rows(p, x_);
      fluid_.bind(x_.data(), p.size());
      q = x_.data();
    }
    find_motions(q);
    constrain(p.size());
    hold(p.size());
    return this->finish(p);
  }

  /// Keeps the loads that the noise alone causes at x, where J is.
  void find_noise_loads(long particles)
  {
    StokesProblem noise = this->problem({{1.0, 0}});
    noise.body_force = {};
    noise.wall_velocity = {};
    fluid_.solve(noise);
    fluid_.interpolate(motion_.linear.data());
    if (turns()) interpolate_turning(motion_);
    ConstraintProblem at_x = constraint_problem(particles);
    at_x.given = at_rest(constraint_);
    at_x.tolerance = std::max(at_x.tolerance, noise_loads_tolerance);
    iterations_ += solver_.solve(at_x, mobility(), sum(), motion_).iterations;
    noise_loads_.keep(solver_.loads(), particles, how_.moments);
    fluid_.clear();
  }

  /// Spreads what acts on free particles, with their thermal drift.
  void spread_known(const Particles &p)
  {
    check_finite_forces(execution(), p);
    const bool drift = plan_.drift == Drift::exact;
    fluid_.spread(known(p, p.force()), drift && !constraint_.held ? plan_.kT : 0.0);
    if (drift && constraint_.held) {
      energy_.resize(vector_size * p.size());
      execution().for_each("bdh::energies", p.size(),
                           FreeEnergies{constraint_, plan_.kT, energy_.data()});
      fluid_.spread_drift(energy_.data());
    }
    if (!plan_.turns) return;
    check_finite_torques(execution(), p);
    fluid_.spread_torque(known(p, p.torque()));
  }
  const double *known(const Particles &p, const double *loads)
  {
    if (!constraint_.held) return loads;
    known_.resize(vector_size * p.size());
    execution().for_each("bdh::known_loads", p.size(),
                         KnownLoads{constraint_, loads, known_.data()});
    return known_.data();
  }

  /// motion_ := the motions at q in the fluid as it is.
  void find_motions(const double *q)
  {
    this->particle_velocity(q, motion_.linear);
    if (turns()) {
      interpolate_turning(motion_);
      this->turn_with_flow(q, motion_.angular);
    }
    if (how_.moments != Moments::stresslet) return;
    const long n = ssize(motion_.strain) / strain_numbers;
    for (const LinearFlow &flow : {shear(), plan_.walls.known_flow()}) {
      if (!flow.flows()) continue;
      AddStrain add{{}, motion_.strain.data()};
      const std::array<double, strain_numbers> strain = flow.strain();
      std::copy(strain.begin(), strain.end(), add.flow);
      execution().for_each("bdh::strain_of_flow", n, add);
    }
  }
  LinearFlow shear() const
  {
    LinearFlow flow;
    flow.gradient[0] = plan_.shear_rate;
    return flow;
  }

  /// motion_ := that with the unknown loads.
  void constrain(long particles)
  {
    const ConstraintProblem problem = constraint_problem(particles);
    const auto added = [this](double share) { add_wall_forces(share); };
    iterations_ += solver_.solve(problem, mobility(), sum(), motion_, added).iterations;
    if (noise_loads_.kept()) noise_loads_.take_from(solver_.loads());
  }
  ConstraintProblem constraint_problem(long particles) const
  {
    ConstraintProblem problem;
    problem.given = constraint_;
    problem.moments = how_.moments;
    problem.particles = particles;
    problem.root = {nullptr, how_.radius};
    problem.tolerance = how_.tolerance;
    problem.least_eigenvalue = least_eigenvalue;
    problem.limit = how_.limit;
    return problem;
  }
  auto mobility()
  {
    return [this](const Moved &loads, Moved &motions) { move(loads, motions); };
  }
  auto sum() const
  {
    return [this](double mine) { return fluid_.comm().sum(mine); };
  }
  /// motions := those by these loads, where J is.  Particles that are free have stresslets alone.
  void move(const Moved &loads, Moved &motions)
  {
    fluid_.clear();
    if (constraint_.held) {
      fluid_.spread(loads.linear.data(), 0.0);
      if (turns()) fluid_.spread_torque(loads.angular.data());
    }
    if (constraint_.rigid) fluid_.spread_stresslet(loads.strain.data());
    StokesProblem quiet;
    quiet.viscosity = plan_.viscosity;
    quiet.tolerance = plan_.tolerance;
    fluid_.solve(quiet);
    fluid_.interpolate(motions.linear.data());
    if (turns()) interpolate_turning(motions);
  }
  /// Angular velocities, and rates of strain from the same differences.
  void interpolate_turning(Moved &motions)
  {
    if (how_.moments == Moments::stresslet)
      fluid_.gradient(motions.strain.data(), motions.angular.data());
    else
      fluid_.angular_velocity(motions.angular.data());
  }
  void add_wall_forces(double share)
  {
    const SolveReport last = fluid_.report();
    for (int d = 0; d < 3; ++d)
      for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3; ++c)
          report_.wall_force[d][side][c] += share * last.wall_force[d][side][c];
  }

  /// u_ and omega_ := the motions, and those that are given exactly as given.
  void hold(long particles)
  {
    const auto set = [&](const double *given, Vector &v) {
      if (constraint_.held)
        execution().for_each("bdh::held", particles, SetHeld{constraint_, given, v.data()});
    };
    set(constraint_.velocity, motion_.linear);
    scale(execution(), 1.0, motion_.linear, u_);
    if (!turns()) return;
    set(constraint_.angular, motion_.angular);
    this->omega_.resize(motion_.angular.size());
    scale(execution(), 1.0, motion_.angular, this->omega_);
  }

  // See ConstraintProblem: particles whose constraint is that close to singular lie at one place.
  static constexpr double least_eigenvalue = 1e-6;

  Constraint constraint_;
  ConstraintPlan how_;
  ConstraintSolver<Execution> solver_;
  NoiseLoads<Execution> noise_loads_;
  Moved motion_;
  Vector known_, energy_;
  SolveReport report_;
  int iterations_ = 0;
};

}    // namespace bdh
#endif
