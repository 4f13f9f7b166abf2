// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Time steps of Brownian dynamics with positively split Ewald, once for host and device.
#ifndef BDH_PSE_STEP_H
#define BDH_PSE_STEP_H

#include "base/bytes_of.h"
#include "base/particles.h"
#include "base/pieces.h"
#include "base/ssize.h"
#include "base/vectors.h"
#include "pse/mobility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bdh {

/// What one step needs to know.  Units: any consistent set.
struct PseStepPlan {
  double dt = 0.0;                      ///< [time]
  double noise_dt = 0.0;                ///< for which the noise of scheme euler is drawn; 0: dt
  double kT = 0.0;                      ///< [energy]; 0: no noise
  double viscosity = 1.0;               ///< [mass/(length time)]
  int substeps = 0;                     ///< near steps of scheme split; 0: scheme euler
  PieceChoice *near_steps = nullptr;    ///< chooses them instead, where substeps is not 0
  bool parts = false;            ///< scheme euler keeps the velocities by forces and by noise apart
  bool rotation = false;         ///< particles turn
  int constraint_limit = 100;    ///< iterations of a constraint
  bool noise_loads = false;      ///< the loads of a constraint are kept without their noise
  /// Angular velocity of the background flow, with which particles turn [1/time].
  std::array<double, 3> vorticity{};    ///< half of it
  uint32_t seed = 0;
  uint64_t step = 0;
  bool may_fail = false;    ///< not read: no step of this kind fails

  /// The random velocities.
  PseNoise noise() const { return {2.0 * kT / (noise_dt > 0.0 ? noise_dt : dt), seed, step, 0}; }
};

/// Numbers that scheme split keeps by atom, where the arrays of the particles are.  They go with
/// atoms that change their place.
struct KeptByAtom {
  const int *local;    ///< atom of each particle
  /// Displacement since the beginning of the step, dof numbers, followed by as many of the
  /// rotation.
  double *moved;
  long moved_stride;
  /// The last near noise, of variance 1, in noise_entries numbers, followed by dof of the rotation;
  /// null at kT = 0 where near steps are not chosen.
  double *last_noise;
  long noise_stride;
  /// The forces where the last near step began, in force_entries numbers, with the same stride;
  /// null where near steps are not chosen.
  double *force = nullptr;
};

/// What lies around the particles where they are now.
template <class Neighbors> class PseSurroundings {
 public:
  virtual ~PseSurroundings() = default;
  /// Collective.  Finds the particles among the atoms of the list.  True if `mine` is true on any
  /// rank.
  virtual bool look(bool mine) = 0;
  virtual Neighbors neighbors() = 0;
  /// Number of particles, with those of other ranks that are neighbours.
  virtual long all() = 0;
  virtual KeptByAtom kept() = 0;
  /// Radii of the particles and of those of other ranks; null where all are equal and nothing
  /// turns.
  virtual const double *radii() { return nullptr; }
  /// Collective.  The neighbors as they are after displacements, dof per particle.
  virtual Neighbors shifted(const double *displacement) = 0;
  /// Collective.  The sum over the ranks.
  virtual double sum(double mine) const = 0;
  virtual double greatest(double mine) const = 0;    ///< the same for the greatest number
};

/// The particles as a mobility is bound to them.
template <class Vector, class Neighbors> PseParticles<Neighbors>
particles_among(const ParticlesOf<Vector> &p, PseSurroundings<Neighbors> &around)
{
  return {p.size(), p.x(), p.ids(), around.neighbors(), around.all(), around.radii()};
}

/// The velocities of a step by their causes, on the host, dof numbers per particle.
struct PseVelocityParts {
  std::vector<double> by_forces, by_noise;
  std::vector<double> turned_by_forces, turned_by_noise;    ///< angular; empty if nothing turns
};

/// What the schemes have in common: they look around, bind a mobility, and move the particles.
/// Execution: where the arrays of the particles are.
template <class Execution, class Neighbors> class PseScheme {
 public:
  using Vector = typename Execution::ParticleVector;
  using Particles = ParticlesOf<Vector>;
  using Mobility = PseMobility<Neighbors>;
  using Surroundings = PseSurroundings<Neighbors>;

 protected:
  /// Numbers of particles, dof each; those of the rotation are empty if nothing turns.
  struct Motion {
    Vector linear, angular;
  };

  explicit PseScheme(const Execution &execution) : execution_(execution) {}

  PseForces look_and_bind(const Particles &p, Surroundings &around, Mobility &M)
  {
    const PseForces forces = look(p, around);
    M.bind(particles_among(p, around));
    return forces;
  }

  /// Checks forces and positions, and looks around.
  PseForces look(const Particles &p, Surroundings &around)
  {
    check_finite_forces(execution_, p);
    const long lost = execution_.first("bdh::lost", p.size(), NotFinite{p.x()});
    if (lost >= 0)
      throw BadParticle(lost, "its position is not a finite number: use a smaller timestep, and "
                              "look at what else moves atoms");
    if (turn_) check_finite_torques(execution_, p);
    const double *torque = turn_ ? p.torque() : nullptr;
    const bool mine = execution_.first("bdh::forces", p.size(), HasForce{p.force(), torque}) >= 0;
    return {p.force(), around.look(mine), torque};
  }

  /// x += velocity_ dt, and likewise orientations.
  void finish(Particles &p, const PseStepPlan &plan)
  {
    resize(displacement_, p);
    scale(execution_, plan.dt, velocity_.linear, displacement_);
    p.finish(displacement_, velocity_.linear);
    if (!turn_) return;
    rotate_by(plan.dt, plan);
    scale(execution_, 1.0 / plan.dt, rotation_, velocity_.angular);
    p.turn(rotation_, velocity_.angular);
  }

  /// rotation_ := time times the angular velocities, together with that of the flow in a step.
  void rotate_by(double time, const PseStepPlan &plan)
  {
    rotation_.resize(velocity_.angular.size());
    execution_.for_each("bdh::rotation", ssize(rotation_) / dof,
                        RotateWithFlow{velocity_.angular.data(),
                                       time,
                                       plan.dt,
                                       {plan.vorticity[0], plan.vorticity[1], plan.vorticity[2]},
                                       rotation_.data()});
  }

  static void resize(Vector &v, const Particles &p) { v.resize(dof * p.size()); }
  /// The motion, with room for these particles.
  PseVelocities sized(Motion &m, const Particles &p) const
  {
    resize(m.linear, p);
    if (!turn_) return m.linear.data();
    resize(m.angular, p);
    return {m.linear.data(), m.angular.data()};
  }
  std::size_t memory() const
  {
    return bytes_of(displacement_, rotation_, velocity_.linear, velocity_.angular);
  }

  Execution execution_;
  bool turn_ = false;
  Motion velocity_;
  Vector displacement_, rotation_;
};

/// Takes time steps.
template <class Execution, class Neighbors> class PseStep : public PseScheme<Execution, Neighbors> {
 public:
  using Base = PseScheme<Execution, Neighbors>;
  using typename Base::Mobility;
  using typename Base::Particles;
  using typename Base::Surroundings;
  using typename Base::Vector;

  explicit PseStep(const Execution &execution = Execution()) : Base(execution) {}

  /// Collective.  One step of the scheme that the plan names.  Throws BadParticle when a position
  /// or a force is not a finite number.
  PseReport take(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    M.set_viscosity(plan.viscosity);
    turn_ = plan.rotation;
    if (plan.substeps > 0) return split(p, around, M, plan);
    return plan.parts ? euler_in_parts(p, around, M, plan) : euler(p, around, M, plan);
  }

  /// Velocities of the last step, if the plan asked for its parts.
  PseVelocityParts parts() const
  {
    return {Execution::to_host(by_forces_.linear), Execution::to_host(by_noise_.linear),
            Execution::to_host(by_forces_.angular), Execution::to_host(by_noise_.angular)};
  }

  std::size_t memory() const
  {
    std::size_t bytes = Base::memory();
    for (const Motion *m : {&random_, &by_forces_, &by_noise_})
      bytes += bytes_of(m->linear, m->angular);
    return bytes;
  }

 protected:
  using typename Base::Motion;

  /// Euler-Maruyama: x += (M F + noise) dt.
  PseReport euler(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const PseForces forces = this->look_and_bind(p, around, M);
    const PseReport report = M.fluctuate(forces, plan.noise(), this->sized(velocity_, p));
    this->finish(p, plan);
    return report;
  }

  /// The same with M F and the noise kept apart; each needs transforms of its own.
  PseReport euler_in_parts(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const PseForces forces = this->look_and_bind(p, around, M), none;
    M.apply(forces, this->sized(by_forces_, p));
    const PseReport report = M.fluctuate(none, plan.noise(), this->sized(by_noise_, p));
    this->sized(velocity_, p);
    const auto add_up = [this](const Vector &a, const Vector &b, Vector &to) {
      combine(execution_, 1.0, a.data(), 1.0, b.data(), to);
    };
    add_up(by_forces_.linear, by_noise_.linear, velocity_.linear);
    if (turn_) add_up(by_forces_.angular, by_noise_.angular, velocity_.angular);
    this->finish(p, plan);
    return report;
  }

  /// Scheme split, with a step H of n near steps h: the far flow by Euler-Maruyama, then the near
  /// one by n steps of Leimkuhler and Matthews, whose noise is the mean of two successive ones:
  ///
  ///     q += H M_w F + sqrt(2 kT H) M_w^(1/2) w
  ///     q += h M_r F + sqrt(2 kT h) (z + z')/2,   z' = M_r^(1/2) w';  z := z'     n times
  ///
  /// Each near step takes the forces where it begins.  The near steps come last, so that what the
  /// far step did to stiff pairs has decayed where positions are seen.  Where near steps are chosen
  /// they may have different lengths; sqrt(h) then belongs to z.
  PseReport split(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const double H = plan.dt;
    const PseForces forces = this->look_and_bind(p, around, M);
    if (plan.near_steps) end_near_step(p, around, *plan.near_steps);
    M.far(forces, plan.noise(), this->sized(velocity_, p));
    this->resize(displacement_, p);
    scale(execution_, H, velocity_.linear, displacement_);
    if (turn_) this->rotate_by(H, plan);
    KeptByAtom kept = around.kept();
    execution_.for_each(
        "bdh::moved", p.size(),
        ClearKept{kept.local, kept.moved_stride, kept.moved, turn_ ? 2 * dof : dof});
    const PseReport report = plan.near_steps ? chosen_near_steps(p, around, M, plan)
                                             : equal_near_steps(p, around, M, plan);
    add_to_moved(p, around);
    kept = around.kept();
    this->sized(velocity_, p);
    const auto mean_of = [&](double *moved, Vector &v) {
      execution_.for_each("bdh::velocities", p.size(),
                          DivideKept{kept.local, kept.moved_stride, moved, H, v.data()});
    };
    mean_of(kept.moved, velocity_.linear);
    if (turn_) mean_of(kept.moved + dof, velocity_.angular);
    p.finish(displacement_, velocity_.linear);
    if (turn_) p.turn(rotation_, velocity_.angular);
    return report;
  }

  /// All near steps of a step.  Each one first moves the particles by what came before it.
  PseReport equal_near_steps(Particles &p, Surroundings &around, Mobility &M,
                             const PseStepPlan &plan)
  {
    PseReport report;
    for (int substep = 0; substep < plan.substeps; ++substep) {
      move_by_last(p, around);
      report.add(near_step(p, around, M, plan, {plan.dt / plan.substeps, plan.step, substep}));
    }
    return report;
  }
  PseReport chosen_near_steps(Particles &p, Surroundings &around, Mobility &M,
                              const PseStepPlan &plan)
  {
    PieceChoice &choice = *plan.near_steps;
    PseReport report;
    for (PlaceInStep place; !place.is_over();) {
      move_by_last(p, around);
      end_near_step(p, around, choice);
      const double force =
          around.greatest(execution_.greatest("bdh::force", p.size(), LengthOf{p.force()}));
      const int depth = place.fit(choice.depth(force, deepest_piece));
      const double h = std::ldexp(plan.dt, -depth);
      const KeptByAtom kept = around.kept();
      execution_.for_each("bdh::keep_force", p.size(),
                          KeepForce{kept.local, kept.noise_stride, p.force(), kept.force});
      choice.begin(force, h);
      report.add(
          near_step(p, around, M, plan, {h, piece_of_step(plan.step, place.node(depth)), 0}));
      place.pass(depth);
    }
    return report;
  }
  /// Collective.  Tells the choice by how much the last near step has changed forces, if it has not
  /// been told.
  void end_near_step(const Particles &p, Surroundings &around, PieceChoice &choice) const
  {
    const KeptByAtom kept = around.kept();
    choice.end(around.greatest(execution_.greatest(
        "bdh::change", p.size(),
        ChangeSinceKept{kept.local, kept.noise_stride, p.force(), kept.force})));
  }
  void move_by_last(Particles &p, Surroundings &around)
  {
    add_to_moved(p, around);
    p.move_and_update_forces(displacement_, turn_ ? &rotation_ : nullptr);
  }

  struct NearStepPlan {
    double h;
    uint64_t piece;    // of its noise
    int stage;
  };
  /// displacement_ and rotation_ := those of one near step.
  PseReport near_step(const Particles &p, Surroundings &around, Mobility &M,
                      const PseStepPlan &plan, const NearStepPlan &near)
  {
    const double h = near.h;
    const PseForces forces = this->look(p, around);
    M.bind_near(particles_among(p, around));
    this->resize(displacement_, p);
    if (turn_) this->resize(rotation_, p);
    const PseVelocities random = this->sized(random_, p);
    // The noise that is kept does not depend on the step's length.
    const PseNoise noise{plan.kT > 0.0 ? 1.0 : 0.0, plan.seed, near.piece,
                         static_cast<uint32_t>(near.stage)};
    double *const rotation = turn_ ? rotation_.data() : nullptr;
    const PseReport report = M.near(forces, noise, {{displacement_.data(), rotation}, random});
    const KeptByAtom kept = around.kept();
    if (noise.acts()) {
      execution_.for_each("bdh::near", p.size(),
                          NearStep{kept.local, kept.noise_stride, h, std::sqrt(2.0 * plan.kT * h),
                                   random.linear, random.angular, kept.last_noise,
                                   displacement_.data(), rotation});
    } else {
      scale(execution_, h, displacement_, displacement_);
      if (turn_) scale(execution_, h, rotation_, rotation_);
    }
    return report;
  }

  void add_to_moved(const Particles &p, Surroundings &around) const
  {
    const KeptByAtom kept = around.kept();
    execution_.for_each("bdh::moved", p.size(),
                        AddToKept{kept.local, kept.moved_stride, displacement_.data(), kept.moved});
    if (turn_)
      execution_.for_each(
          "bdh::moved", p.size(),
          TurnKept{kept.local, kept.moved_stride, rotation_.data(), kept.moved + dof});
  }
  using Base::displacement_;
  using Base::execution_;
  using Base::rotation_;
  using Base::turn_;
  using Base::velocity_;

  Motion random_, by_forces_, by_noise_;
};

}    // namespace bdh
#endif
