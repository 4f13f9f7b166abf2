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
  int substeps = 0;          ///< near steps of scheme split; 0: scheme euler
  bool parts = false;        ///< scheme euler keeps the velocities by forces and by noise apart
  uint32_t seed = 0;
  uint64_t step = 0;

  /// The random velocities over a time [time].
  PseNoise noise(double time) const { return {2.0 * kT / time, seed, step, 0}; }
};

/// Numbers that scheme split keeps by atom, where the arrays of the particles are.  They go with
/// atoms that change their place.
struct KeptByAtom {
  const int *local;    ///< atom of each particle
  double *moved;       ///< displacement since the beginning of the step, dof numbers
  long moved_stride;
  /// The last near noise, of variance 1, in noise_entries numbers; null at kT = 0.
  double *last_noise;
  long noise_stride;
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
};

/// The particles as a mobility is bound to them.
template <class Vector, class Neighbors> PseParticles<Neighbors>
particles_among(const ParticlesOf<Vector> &p, PseSurroundings<Neighbors> &around)
{
  return {p.size(), p.x(), p.ids(), around.neighbors(), around.all()};
}

/// Takes time steps.  Execution: where the arrays of the particles are.
template <class Execution, class Neighbors> class PseStep {
 public:
  using Vector = typename Execution::ParticleVector;
  using Particles = ParticlesOf<Vector>;
  using Mobility = PseMobility<Neighbors>;
  using Surroundings = PseSurroundings<Neighbors>;

  explicit PseStep(const Execution &execution = Execution()) : execution_(execution) {}

  /// Collective.  One step of the scheme that the plan names.  Throws BadParticle when a position
  /// or a force is not a finite number.
  PseReport take(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    M.set_viscosity(plan.viscosity);
    if (plan.substeps > 0) return split(p, around, M, plan);
    return plan.parts ? euler_in_parts(p, around, M, plan) : euler(p, around, M, plan);
  }

  /// Velocities of the last step in parts, dof per particle.
  std::vector<double> by_forces() const { return Execution::to_host(by_forces_); }
  std::vector<double> by_noise() const { return Execution::to_host(by_noise_); }

  std::size_t memory() const
  {
    return bytes_of(velocity_, displacement_, random_, by_forces_, by_noise_);
  }

 private:
  /// Euler-Maruyama: x += (M F + noise) dt.
  PseReport euler(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const PseForces forces = look_and_bind(p, around, M);
    resize(velocity_, p);
    const PseReport report = M.fluctuate(forces, plan.noise(plan.dt), velocity_.data());
    finish(p, plan.dt);
    return report;
  }

  /// The same with M F and the noise kept apart; each needs transforms of its own.
  PseReport euler_in_parts(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const PseForces forces = look_and_bind(p, around, M), none;
    resize(by_forces_, p);
    resize(by_noise_, p);
    M.apply(forces, by_forces_.data());
    const PseReport report = M.fluctuate(none, plan.noise(plan.dt), by_noise_.data());
    resize(velocity_, p);
    execution_.for_each("bdh::combine", dof * p.size(),
                        Combine{1.0, by_forces_.data(), 1.0, by_noise_.data(), velocity_.data()});
    finish(p, plan.dt);
    return report;
  }

  /// Scheme split, with a step H of n near steps h: the far flow by Euler-Maruyama, then the near
  /// one by n steps of Leimkuhler and Matthews, whose noise is the mean of two successive ones:
  ///
  ///     q += H M_w F + sqrt(2 kT H) M_w^(1/2) w
  ///     q += h M_r F + sqrt(2 kT h) (z + z')/2,   z' = M_r^(1/2) w';  z := z'     n times
  ///
  /// Each near step takes the forces where it begins.  The near steps come last, so that what the
  /// far step did to stiff pairs has decayed where positions are seen.
  PseReport split(Particles &p, Surroundings &around, Mobility &M, const PseStepPlan &plan)
  {
    const double H = plan.dt;
    const PseForces forces = look_and_bind(p, around, M);
    resize(velocity_, p);
    M.far(forces, plan.noise(H), velocity_.data());
    resize(displacement_, p);
    scale(H, velocity_, displacement_);
    KeptByAtom kept = around.kept();
    execution_.for_each("bdh::moved", p.size(),
                        ClearKept{kept.local, kept.moved_stride, kept.moved});
    PseReport report;
    for (int substep = 0; substep < plan.substeps; ++substep) {
      add_to_moved(p, around);
      p.move_and_update_forces(displacement_, nullptr);
      const PseReport near = near_step(p, around, M, plan, substep);
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

  /// displacement_ := that of one near step.
  PseReport near_step(const Particles &p, Surroundings &around, Mobility &M,
                      const PseStepPlan &plan, uint32_t substep)
  {
    const double h = plan.dt / plan.substeps;
    const PseForces forces = look(p, around);
    M.bind_near(particles_among(p, around));
    resize(displacement_, p);
    resize(random_, p);
    // The noise that is kept does not depend on the step's length.
    const PseNoise noise{plan.kT > 0.0 ? 1.0 : 0.0, plan.seed, plan.step, substep};
    const PseReport report = M.near(forces, noise, {displacement_.data(), random_.data()});
    const KeptByAtom kept = around.kept();
    if (noise.acts())
      execution_.for_each("bdh::near", p.size(),
                          NearStep{kept.local, kept.noise_stride, h, std::sqrt(2.0 * plan.kT * h),
                                   random_.data(), kept.last_noise, displacement_.data()});
    else
      scale(h, displacement_, displacement_);
    return report;
  }

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
    const bool mine = execution_.first("bdh::forces", p.size(), HasForce{p.force()}) >= 0;
    return {p.force(), around.look(mine)};
  }

  /// x += velocity_ dt.
  void finish(Particles &p, double dt)
  {
    resize(displacement_, p);
    scale(dt, velocity_, displacement_);
    p.finish(displacement_, velocity_);
  }

  void add_to_moved(const Particles &p, Surroundings &around) const
  {
    const KeptByAtom kept = around.kept();
    execution_.for_each("bdh::moved", p.size(),
                        AddToKept{kept.local, kept.moved_stride, displacement_.data(), kept.moved});
  }
  static void resize(Vector &v, const Particles &p) { v.resize(dof * p.size()); }
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
