// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Time steps of Brownian dynamics with the fluctuating immersed boundary method.  [FIB sec. IV]
///
///     dq = M F dt + kT (div M) dt + sqrt(2 kT) M^(1/2) dW
///
/// Where particles turn, q includes their orientations, F the torques, and M the blocks of angular
/// velocities.  M does not depend on orientations, so div M is the divergence with respect to
/// positions, of the rows of angular velocities too:
///
///     kT d/dq_j (K L^-1 S_j) = K L^-1 kT div S + kT (d K/dq_j) L^-1 S_j
///
/// The first part is the angular velocity in the flow that the thermal drift of translation drives.
/// The second comes from taking K at the middle of the step, or at both of its ends, after
/// positions have moved with the noise that turns the particles.  So no scheme needs more drift
/// than without rotation, and euler leaves out the second part here, too.
///
/// The steps are written once for host and device, as sequences of spread, solve and interpolate.
#ifndef BDH_FIB_STEP_H
#define BDH_FIB_STEP_H

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/particles.h"
#include "base/rotation_kernel.h"
#include "base/ssize.h"
#include "base/vectors.h"
#include "fib/confinement.h"
#include "fib/fluid.h"
#include "fib/moving_walls.h"
#include "fib/step_kernel.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace bdh {

enum class Scheme { midpoint, improved, euler, trapezoidal };
enum class Drift { no, exact, finite_difference };

/// Throw InvalidOption for an unknown name.
Scheme scheme_from_name(const std::string &name);
const char *scheme_name(Scheme scheme);

/// What one step needs to know, in any consistent set of units.
struct StepPlan {
  Scheme scheme = Scheme::midpoint;
  Drift drift = Drift::exact;
  /// For the midpoint scheme; false takes J at the beginning of the step, which is exact without
  /// noise and flow.
  bool corrector = true;
  bool turns = false;                                 ///< particles turn
  double dt = 0.0;                                    ///< [time]
  double noise_dt = 0.0;                              ///< for which noise is drawn [time]; 0: dt
  double kT = 0.0;                                    ///< [energy]; 0 means no noise and no drift
  double viscosity = 1.0;                             ///< [mass/(length time)]
  double shear_rate = 0.0;                            ///< background flow u = rate y e_x [1/time]
  WallMotion walls;                                   ///< walls that move
  std::array<double, 3> body_force{0.0, 0.0, 0.0};    ///< force on the fluid [force/volume]
  double tolerance = 1e-8;    ///< relative residual of a solver that iterates
  Crossing crossing = Crossing::error;
  /// A step that would take a particle over a wall is not taken if crossing is `error`.
  bool may_fail = false;
  double delta = 1e-6;    ///< step of the random finite difference, in units of h
  uint32_t seed = 0;
  uint64_t step = 0;
};

/// One time step, wherever the arrays are.  Place is FibOnHost, or its counterpart on a device;
/// Fluid may be another one that spreads, solves and interpolates, such as FreeFluid.
template <class Place, class Fluid = FibFluid<Place>> class BrownianStep {
 public:
  using Vector = typename Place::ParticleVector;
  using Particles = ParticlesOf<Vector>;

  explicit BrownianStep(Fluid &fluid) :
      fluid_(fluid), execution_(fluid.execution()), confinement_(fluid)
  {}

  /// Collective.  Throws BadParticle when a position or a force is not a finite number.  On a grid
  /// that leaves out a part of the box, throws GridTooLow on all ranks if that part is needed.
  /// False on all ranks if the step has not been taken and nothing has moved (plan.may_fail).
  bool take(Particles &particles, const StepPlan &plan)
  {
    begin(plan);
    if (plan.scheme == Scheme::improved)
      improved(particles);
    else
      while (!one_solve(particles)) {
        if (plan.may_fail && plan.crossing == Crossing::error) return false;
        confinement_.next_attempt(particles, x_);
      }
    return true;
  }

  /// See Confinement.
  double crossings() const { return confinement_.crossings(); }

  /// Of the last solve of the last step.
  SolveReport report() const { return fluid_.report(); }

  std::size_t memory() const { return bytes_of(u_, v_, x_, w_, omega_, other_omega_); }

 protected:
  /// Begins a step.
  void begin(const StepPlan &plan)
  {
    plan_ = plan;
    confinement_.begin_step(plan.crossing, plan.may_fail);
  }

  /// Takes a step of FIB eq. (33)-(35), (43), (44): one solve at q^n, then one or two
  /// interpolations.  Returns false, and has moved nothing, if a particle would cross a wall and
  /// the step is to be drawn again.
  bool one_solve(Particles &p)
  {
    resize(p.size());
    fluid_.bind(p.x(), p.size());
    fluid_.clear();
    spread_forces(p, plan_.drift == Drift::exact);
    if (plan_.drift == Drift::finite_difference) {
      spread_finite_difference(p, p.x());
      fluid_.bind(p.x(), p.size());
    }
    fluid_.solve(problem({{1.0, 0}}));
    particle_velocity(p.x(), u_);
    const double *q = p.x();
    const bool both_ends = plan_.scheme == Scheme::trapezoidal;
    if (both_ends || (plan_.scheme == Scheme::midpoint && plan_.corrector)) {
      if (both_ends) angular_velocity(q, other_omega_);
      combine(execution_, 1.0, p.x(), both_ends ? plan_.dt : 0.5 * plan_.dt, u_.data(), x_);
      if (!confinement_.confine(p, x_)) return false;
      q = x_.data();
      second_velocity(p);
    }
    angular_velocity(q, omega_);
    if (both_ends) average_of_ends();
    return finish(p);
  }

  /// Moves the particles with u_ and turns them with omega_.  Returns false, and has moved nothing,
  /// if one would cross a wall and the step is to be drawn again.
  bool finish(Particles &p)
  {
    combine(execution_, 1.0, p.x(), plan_.dt, u_.data(), x_);
    if (!confinement_.confine(p, x_)) return false;
    // The difference of positions would add their roundings to the displacement, so only walls may
    // change it.
    w_.resize(u_.size());
    scale(execution_, plan_.dt, u_, w_);
    confinement_.take_mirrored(p, x_, w_);
    p.finish(w_, u_);
    if (plan_.turns) {
      scale(execution_, plan_.dt, omega_, w_);
      p.turn(w_, omega_);
    }
    return true;
  }

  /// Takes a step of FIB eq. (38): a solve at q^n predicts q^(n+1/2), where forces and a second
  /// solve are taken.  With the exact derivative the thermal drift goes along with the forces at
  /// q^(n+1/2), which the paper finds as accurate as q^n.
  void improved(Particles &p)
  {
    const double root2 = std::sqrt(2.0);
    resize(p.size());
    fluid_.bind(p.x(), p.size());
    fluid_.clear();
    spread_forces(p, false);
    fluid_.solve(problem({{root2, 0}}));
    particle_velocity(p.x(), u_);
    Vector half_step;
    half_step.resize(u_.size());
    scale(execution_, 0.5 * plan_.dt, u_, half_step);
    confine_displacement(p, half_step);
    confinement_.require_rows(p, x_);
    angular_velocity(p.x(), omega_);
    Vector half_turn;
    half_turn.resize(omega_.size());
    scale(execution_, 0.5 * plan_.dt, omega_, half_turn);
    p.move_and_update_forces(half_step, plan_.turns ? &half_turn : nullptr);

    resize(p.size());
    fluid_.clear();
    if (plan_.drift == Drift::finite_difference) {
      combine(execution_, 1.0, p.x(), -1.0, half_step.data(), x_);
      spread_finite_difference(p, x_.data());
    }
    fluid_.bind(p.x(), p.size());
    spread_forces(p, plan_.drift == Drift::exact);
    fluid_.solve(problem({{1.0 / root2, 0}, {1.0 / root2, 1}}));
    particle_velocity(p.x(), u_);
    combine(execution_, plan_.dt, u_.data(), -1.0, half_step.data(), half_step);
    confine_displacement(p, half_step);
    p.finish(half_step, u_);
    if (plan_.turns) finish_turn(p, half_turn);
  }

  /// Turns the particles, which have made half_turn, by what is left of the step's rotation.
  void finish_turn(Particles &p, const Vector &half_turn)
  {
    angular_velocity(p.x(), omega_);
    w_.resize(omega_.size());
    scale(execution_, plan_.dt, omega_, w_);
    other_omega_.resize(omega_.size());
    execution_.for_each("bdh::rest_of_turn", p.size(),
                        RestOfTurn{w_.data(), half_turn.data(), other_omega_.data()});
    p.turn(other_omega_, omega_);
  }

  void confine_displacement(const Particles &p, Vector &displacement)
  {
    x_.resize(displacement.size());
    combine(execution_, 1.0, p.x(), 1.0, displacement.data(), x_);
    confinement_.confine(p, x_);
    confinement_.take_mirrored(p, x_, displacement);
  }

  void resize(long particles)
  {
    const std::size_t size = 3 * particles;
    u_.resize(size);
    v_.resize(size);
    x_.resize(size);
  }

  StokesProblem problem(std::vector<StressDraw> stress) const
  {
    StokesProblem s;
    s.viscosity = plan_.viscosity;
    s.kT_over_dt = plan_.kT / (plan_.noise_dt > 0.0 ? plan_.noise_dt : plan_.dt);
    s.seed = plan_.seed;
    s.step = plan_.step;
    s.body_force = plan_.body_force;
    s.wall_velocity = plan_.walls.left_to_solver();
    s.tolerance = plan_.tolerance;
    for (StressDraw &draw : stress) draw.stage += stages * confinement_.attempt();
    if (plan_.kT > 0.0) s.stress = std::move(stress);
    return s;
  }

  void spread_forces(const Particles &p, bool drift)
  {
    check_finite_forces(execution_, p);
    fluid_.spread(p.force(), drift ? plan_.kT : 0.0);
    if (!plan_.turns) return;
    check_finite_torques(execution_, p);
    fluid_.spread_torque(p.torque());
  }

  /// f += kT/delta [S(q + delta/2 W) - S(q - delta/2 W)] W, the second line of FIB eq. (33).
  /// Leaves the fluid bound to other positions.
  void spread_finite_difference(const Particles &p, const double *q)
  {
    const long n = p.size();
    const double h = fluid_.grid().h(0), delta = plan_.delta * h, strength = plan_.kT / delta;
    Vector shifted;
    shifted.resize(3 * n);
    w_.resize(shifted.size());
    execution_.for_draws("bdh::finite_difference", n,
                         {plan_.seed, Stream::finite_difference, plan_.step, 0}, p.ids(),
                         StoreNormals<double>{w_.data(), 3, 0, 3, 0});
    for (const double sign : {1.0, -1.0}) {
      combine(execution_, 1.0, q, sign * 0.5 * delta, w_.data(), shifted);
      // A shifted position may be beyond a wall, where the kernel's formula still holds.
      fluid_.bind(shifted.data(), n, 1.0);
      scale(execution_, sign * strength, w_, shifted);
      fluid_.spread(shifted.data(), 0.0);
    }
  }

  /// u := J v + background flow at q (which J leaves as it is: the kernels are symmetric) + motion
  /// of the walls.
  void particle_velocity(const double *q, Vector &u)
  {
    fluid_.interpolate(u.data());
    const long n = ssize(u) / 3;
    if (plan_.shear_rate != 0.0)
      execution_.for_each(
          "bdh::shear", n,
          AddLinearFlow{1, 0.0, {0.0, 0.0, 0.0}, {plan_.shear_rate, 0.0, 0.0}, q, u.data()});
    plan_.walls.for_adders(
        q, u.data(), [this, n](const auto &adder) { execution_.for_each("bdh::walls", n, adder); });
  }

  /// Where particles turn: omega := their angular velocities at q, where J is, with those of the
  /// flows that particle_velocity() adds.
  void angular_velocity(const double *q, Vector &omega)
  {
    if (!plan_.turns) return;
    omega.resize(u_.size());
    fluid_.angular_velocity(omega.data());
    turn_with_flow(q, omega);
  }
  /// omega += that of the flows that particle_velocity() adds.
  void turn_with_flow(const double *q, Vector &omega)
  {
    const long n = ssize(u_) / 3;
    if (plan_.shear_rate != 0.0)
      execution_.for_each("bdh::shear", n,
                          AddToEach{{0.0, 0.0, -0.5 * plan_.shear_rate}, omega.data()});
    plan_.walls.for_turners(q, omega.data(), [this, n](const auto &adder) {
      execution_.for_each("bdh::walls", n, adder);
    });
  }

  /// u_ := velocity at x_ in the fluid velocity of this step, v_ := what u_ was.
  void second_velocity(const Particles &p)
  {
    confinement_.require_rows(p, x_);
    fluid_.bind(x_.data(), p.size());
    particle_velocity(x_.data(), v_);
    u_.swap(v_);
  }

  void average_of_ends()
  {
    combine(execution_, 0.5, u_.data(), 0.5, v_.data(), u_);
    if (plan_.turns) combine(execution_, 0.5, omega_.data(), 0.5, other_omega_.data(), omega_);
  }

  Fluid &fluid_;
  typename Place::Execution execution_;
  Confinement<Place, Fluid> confinement_;
  StepPlan plan_;
  Vector u_, v_, x_, w_;
  Vector omega_, other_omega_;             // empty where nothing turns
  static constexpr uint32_t stages = 4;    // draws of one attempt
};

}    // namespace bdh
#endif
