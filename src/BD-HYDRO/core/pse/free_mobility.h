// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The mobility without hydrodynamic interactions, 1/(6 pi viscosity a) for each particle, in the
/// place of positively split Ewald.  All of it is near, none is far.
#ifndef BDH_PSE_FREE_MOBILITY_H
#define BDH_PSE_FREE_MOBILITY_H

#include "base/vector_kernel.h"
#include "pse/mobility.h"

#include <cmath>

namespace bdh {

/// Execution: where the arrays of the particles are.
template <class Execution, class Neighbors> class FreeMobility : public PseMobility<Neighbors> {
 public:
  using Particles = PseParticles<Neighbors>;

  explicit FreeMobility(const PsePlan &plan, const Execution &execution = Execution()) :
      plan_(plan), execution_(execution)
  {}

  const PsePlan &plan() const override { return plan_; }
  bool change_radius(const PsePlan &plan) override
  {
    if (!same_but_for_radius(plan, plan_)) return false;
    plan_ = plan;
    return true;
  }
  bool set_cell(const Cell &) override { return false; }
  void set_viscosity(double viscosity) override { viscosity_ = viscosity; }
  void bind(const Particles &particles) override { particles_ = particles; }
  void bind_near(const Particles &particles) override { particles_ = particles; }

  void apply(const PseForces &forces, double *velocity) override
  {
    if (!forces.act) return clear(execution_, particles_, velocity);
    execution_.for_each("bdh::free", dof * particles_.count,
                        Scale<double>{self_mobility(), forces.values, velocity});
  }
  PseReport fluctuate(const PseForces &forces, const PseNoise &noise, double *velocity) override
  {
    apply(forces, velocity);
    add(noise, velocity);
    return {};
  }
  void far(const PseForces &, const PseNoise &, double *velocity) override
  {
    clear(execution_, particles_, velocity);
  }
  PseReport near(const PseForces &forces, const PseNoise &noise,
                 const NearVelocities &velocity) override
  {
    apply(forces, velocity.by_forces);
    if (!noise.acts()) return {};
    clear(execution_, particles_, velocity.by_noise);
    add(noise, velocity.by_noise);
    return {};
  }

  double pairs() const override { return 0.0; }
  std::size_t grid_memory() const override { return 0; }
  std::size_t particle_memory() const override { return 0; }

 private:
  double self_mobility() const { return free_mobility(plan_.radius, viscosity_); }
  /// velocity += sqrt(variance mu) z
  void add(const PseNoise &noise, double *velocity) const
  {
    if (!noise.acts()) return;
    execution_.for_each("bdh::free_noise", particles_.count,
                        AddNormals{noise.counter(Stream::lanczos), particles_.ids,
                                   std::sqrt(noise.variance * self_mobility()), dof, velocity});
  }

  PsePlan plan_;
  Execution execution_;
  Particles particles_;
  double viscosity_ = std::numeric_limits<double>::quiet_NaN();
};

}    // namespace bdh
#endif
