// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The mobility without hydrodynamic interactions, 1/(6 pi viscosity a) for each particle, in the
/// place of positively split Ewald.  All of it is near, none is far.
#ifndef BDH_PSE_FREE_MOBILITY_H
#define BDH_PSE_FREE_MOBILITY_H

#include "base/vector_kernel.h"
#include "pse/mobility.h"

#include <cmath>

namespace bdh {

/// Velocities += amplitude of translation or rotation times normals, of spheres of any radii; by
/// particle.
struct AddFreeNoise {
  NoiseCounter translation, rotation;
  const uint64_t *id;
  FreeRoots root;
  double amplitude;
  PseVelocities v;
  BDH_FN void operator()(long p) const
  {
    double z[4];
    normal4(translation, id[p], z[0], z[1], z[2], z[3]);
    for (int c = 0; c < dim; ++c) v.linear[dim * p + c] += amplitude * root.force(p) * z[c];
    if (!v.angular) return;
    normal4(rotation, id[p], z[0], z[1], z[2], z[3]);
    for (int c = 0; c < dim; ++c) v.angular[dim * p + c] += amplitude * root.torque(p) * z[c];
  }
};
/// Velocities := free mobilities times forces and torques; by particle.
struct MoveFreely {
  FreeRoots root;
  double factor;
  PseForces f;
  PseVelocities v;
  BDH_FN void operator()(long p) const
  {
    const double t = factor * root.force(p) * root.force(p),
                 r = factor * root.torque(p) * root.torque(p);
    for (int c = 0; c < dim; ++c) v.linear[dim * p + c] = t * f.values[dim * p + c];
    if (!v.angular) return;
    for (int c = 0; c < dim; ++c)
      v.angular[dim * p + c] = f.torques ? r * f.torques[dim * p + c] : 0.0;
  }
};

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

  void apply(const PseForces &forces, const PseVelocities &velocity) override
  {
    if (!forces.act) return clear(execution_, particles_, velocity);
    if (plan_.is_plain())
      execution_.for_each("bdh::free", dof * particles_.count,
                          Scale<double>{self_mobility(), forces.values, velocity.linear});
    else
      execution_.for_each("bdh::free", particles_.count,
                          MoveFreely{{particles_.radius}, unit(), forces, velocity});
  }
  PseReport fluctuate(const PseForces &forces, const PseNoise &noise,
                      const PseVelocities &velocity) override
  {
    apply(forces, velocity);
    add(noise, velocity);
    return {};
  }
  void far(const PseForces &, const PseNoise &, const PseVelocities &velocity) override
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
  double unit() const { return free_mobility(1.0, viscosity_); }
  /// velocity += sqrt(variance mu) z
  void add(const PseNoise &noise, const PseVelocities &velocity) const
  {
    if (!noise.acts()) return;
    const NoiseCounter counter = noise.counter(Stream::lanczos);
    if (plan_.is_plain())
      execution_.for_draws(
          "bdh::free_noise", particles_.count, counter, particles_.ids,
          AddNormals{std::sqrt(noise.variance * self_mobility()), dof, velocity.linear});
    else
      execution_.for_each("bdh::free_noise", particles_.count,
                          AddFreeNoise{counter,
                                       noise.counter(Stream::lanczos_rotation),
                                       particles_.ids,
                                       {particles_.radius},
                                       std::sqrt(noise.variance * unit()),
                                       velocity});
  }

  PsePlan plan_;
  Execution execution_;
  Particles particles_;
  double viscosity_ = std::numeric_limits<double>::quiet_NaN();
};

}    // namespace bdh
#endif
