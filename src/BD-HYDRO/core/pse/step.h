// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Time steps of Brownian dynamics with positively split Ewald, once for host and device.
#ifndef BDH_PSE_STEP_H
#define BDH_PSE_STEP_H

#include "base/bytes_of.h"
#include "base/particles.h"
#include "base/ssize.h"
#include "pse/mobility.h"

#include <algorithm>
#include <cmath>

namespace bdh {

/// What one step needs to know.  Units: any consistent set.
struct PseStepPlan {
  double dt = 0.0;           ///< [time]
  double kT = 0.0;           ///< [energy]; 0: no noise
  double viscosity = 1.0;    ///< [mass/(length time)]
  int substeps = 0;          ///< near steps of scheme split
  uint32_t seed = 0;
  uint64_t step = 0;
};

/// Numbers that scheme split keeps by atom, where the arrays of the particles are; they go with
/// atoms that change their place.
struct KeptByAtom {
  const int *local;    ///< atom of each particle
  double *moved;       ///< displacement since the beginning of the step
  long moved_stride;
  double *last_noise;    ///< of the last near step, in units of the mobility's root, and 1 if there
                         ///< is one; null at kT = 0
  long noise_stride;
};

/// What lies around the particles where they are now.
template <class Neighbors> class PseSurroundings {
 public:
  virtual ~PseSurroundings() = default;
  /// Collective.  Finds the particles among the atoms of the list.  True if `mine` is so on any
  /// rank.
  virtual bool look(bool mine) = 0;
  virtual Neighbors neighbors() = 0;
  /// Particles, with those of other ranks that are neighbours.
  virtual long all() = 0;
  virtual KeptByAtom kept() = 0;
};

/// Execution: where the arrays of the particles are.
template <class Execution, class Neighbors> class PseStep {
 public:
  explicit PseStep(const Execution &execution = Execution()) : execution_(execution) {}

  using Vector = typename Execution::ParticleVector;
  using Particles = ParticlesOf<Vector>;
  using Mobility = PseMobility<Neighbors>;
  using Surroundings = PseSurroundings<Neighbors>;

  /// Collective.  Checks forces and positions (BadParticle), and looks around.  True if a force
  /// acts anywhere.
  bool look(const Particles &p, Surroundings &around)
  {
    check_finite_forces(execution_, p);
    const long lost = execution_.first("bdh::lost", p.size(), NotFinite{p.x()});
    if (lost >= 0)
      throw BadParticle(lost, "its position is not a finite number: use a smaller timestep, and "
                              "look at what else moves atoms");
    return around.look(execution_.first("bdh::forces", p.size(), HasForce{p.force()}) >= 0);
  }

  /// Collective.  velocity (3 size()) := M F + noise, in one evaluation; after bind().
  PseReport velocity(const Particles &p, bool forces, Mobility &M, const PseStepPlan &plan,
                     Vector &velocity)
  {
    if (plan.kT > 0.0)
      return M.fluctuate(forces, p.force(), {plan.kT / plan.dt, plan.seed, plan.step}, p.ids(),
                         plan.viscosity, velocity.data());
    if (forces)
      M.apply(p.force(), plan.viscosity, velocity.data());
    else
      execution_.for_each("bdh::clear", 3 * p.size(), Clear{velocity.data()});
    return {};
  }

  /// Collective.  Euler-Maruyama.
  PseReport euler(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const bool forces = look_and_bind(p, around, M);
    resize(velocity_, p);
    const PseReport report = velocity(p, forces, M, plan, velocity_);
    finish(p, plan.dt);
    return report;
  }

  /// Collective.  euler() with the velocities by forces and by noise kept apart; each needs
  /// transforms of its own.
  PseReport euler_in_parts(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const bool forces = look_and_bind(p, around, M);
    resize(by_forces_, p);
    resize(by_noise_, p);
    PseStepPlan without_noise = plan;
    without_noise.kT = 0.0;
    velocity(p, forces, M, without_noise, by_forces_);
    const PseReport report = velocity(p, false, M, plan, by_noise_);
    resize(velocity_, p);
    execution_.for_each("bdh::combine", 3 * p.size(),
                        Combine{1.0, by_forces_.data(), 1.0, by_noise_.data(), velocity_.data()});
    finish(p, plan.dt);
    return report;
  }
  /// Of the last euler_in_parts(), 3 per particle.
  std::vector<double> by_forces() const { return Execution::to_host(by_forces_); }
  std::vector<double> by_noise() const { return Execution::to_host(by_noise_); }

  /// Collective.  Scheme split, of step H = n h: the far flow by Euler-Maruyama, then the near one
  /// by n steps after Leimkuhler and Matthews, whose noise is the mean of two successive ones:
  ///
  ///     q += H M_w F + sqrt(2 kT H) M_w^(1/2) w
  ///     q += h M_r F + sqrt(2 kT h) (z + z')/2,   z' = M_r^(1/2) w';  z := z'     n times, F anew
  ///     each time
  ///
  /// The near ones come last, so that what the far step did to stiff pairs has decayed where
  /// positions are seen.
  PseReport split(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const double H = plan.dt;
    const bool forces = look_and_bind(p, around, M);
    resize(velocity_, p);
    M.far(forces, p.force(), {plan.kT / H, plan.seed, plan.step}, plan.viscosity, velocity_.data());
    resize(displacement_, p);
    scale(H, velocity_, displacement_);
    KeptByAtom kept = around.kept();
    execution_.for_each("bdh::moved", p.size(),
                        ClearKept{kept.local, kept.moved_stride, kept.moved});
    PseReport report;
    for (int substep = 0; substep < plan.substeps; ++substep) {
      add_to_moved(p, around);
      p.move_and_update_forces(displacement_);
      const PseReport near = near_step(p, around, M, plan, static_cast<uint32_t>(substep));
      report.iterations += near.iterations;
      report.root_error = std::max(report.root_error, near.root_error);
    }
    add_to_moved(p, around);
    kept = around.kept();
    resize(velocity_, p);
    execution_.for_each("bdh::velocities", p.size(),
                        DivideKept{kept.local, kept.moved_stride, kept.moved, H, velocity_.data()});
    p.finish(displacement_, velocity_);
    return report;
  }

  std::size_t memory() const
  {
    return bytes_of(velocity_, displacement_, random_, by_forces_, by_noise_);
  }

 private:
  bool look_and_bind(const Particles &p, Surroundings &around, Mobility &M)
  {
    const bool forces = look(p, around);
    M.bind(p.x(), p.size(), around.neighbors(), around.all());
    return forces;
  }

  /// x += velocity_ dt.
  void finish(Particles &p, double dt)
  {
    resize(displacement_, p);
    scale(dt, velocity_, displacement_);
    p.finish(displacement_, velocity_);
  }

  /// displacement_ := that of one near step.
  PseReport near_step(const Particles &p, Surroundings &around, Mobility &M,
                      const PseStepPlan &plan, uint32_t substep)
  {
    const double h = plan.dt / plan.substeps;
    const bool forces = look(p, around);
    M.bind_near(p.size(), around.neighbors(), around.all());
    resize(displacement_, p);
    resize(random_, p);
    const PseReport report = M.near(forces, p.force(), {plan.kT / h, plan.seed, plan.step}, substep,
                                    p.ids(), plan.viscosity, displacement_.data(), random_.data());
    const KeptByAtom kept = around.kept();
    if (plan.kT > 0.0)
      execution_.for_each("bdh::near", p.size(),
                          NearStep{kept.local, kept.noise_stride, h, std::sqrt(2.0 * plan.kT * h),
                                   random_.data(), kept.last_noise, displacement_.data()});
    else
      scale(h, displacement_, displacement_);
    return report;
  }

  void add_to_moved(const Particles &p, Surroundings &around) const
  {
    const KeptByAtom kept = around.kept();
    execution_.for_each("bdh::moved", p.size(),
                        AddToKept{kept.local, kept.moved_stride, displacement_.data(), kept.moved});
  }
  static void resize(Vector &v, const Particles &p) { v.resize(3 * p.size()); }
  void scale(double c, const Vector &a, Vector &to)
  {
    execution_.for_each("bdh::scale", ssize(to), Scale<double>{c, a.data(), to.data()});
  }

  Execution execution_;
  Vector velocity_, displacement_, random_;
  Vector by_forces_, by_noise_;
};

}    // namespace bdh
#endif
