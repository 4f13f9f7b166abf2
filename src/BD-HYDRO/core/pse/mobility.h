// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Positively split Ewald: velocities M F and random velocities of covariance 2 kT M/dt.
///
///     M = M_r + M_w,   M^(1/2) dW = M_r^(1/2) dW_1 + M_w^(1/2) dW_2
///
/// See PSE sec. II, eq. (14) and (18).
#ifndef BDH_PSE_MOBILITY_H
#define BDH_PSE_MOBILITY_H

#include "base/comm.h"
#include "base/lanczos.h"
#include "grid/fft.h"
#include "pse/near_mobility.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/real_space.h"
#include "pse/step_kernel.h"
#include "pse/wave_space.h"

#include <limits>
#include <memory>

namespace bdh {

/// What one evaluation did.
struct PseReport {
  int iterations = 0;               ///< of Lanczos; 0 without noise
  int constraint_iterations = 0;    ///< of conjugate gradients
  /// Estimated error of the noise by Lanczos, relative to the whole noise.
  double root_error = 0.0;

  /// Adds that of another part of the same step.
  void add(const PseReport &other)
  {
    iterations += other.iterations;
    constraint_iterations += other.constraint_iterations;
    root_error = root_error > other.root_error ? root_error : other.root_error;
  }
};

/// The plan's grid with some room for this cell, so that a box that grows or leans does not ask for
/// a new one at every step.
std::array<long, 3> roomier_grid(const PsePlan &plan, const Cell &cell);

/// The mobility of bound particles, wherever their arrays are.
///
/// set_cell(), set_viscosity() and bind() come first, in this order.  Velocities
/// may be null on a rank without particles.
template <class Neighbors> class PseMobility {
 public:
  using Particles = PseParticles<Neighbors>;

  virtual ~PseMobility() = default;

  virtual const PsePlan &plan() const = 0;
  /// Works by this plan from now on, if it differs from its own in the radius alone; returns false
  /// if that takes another object.  Not collective.
  virtual bool change_radius(const PsePlan &plan) = 0;
  /// Collective.  The cell as it is now.  Makes a new grid, and returns true, when the old one is
  /// too coarse for it.
  virtual bool set_cell(const Cell &cell) = 0;
  /// The fluid's viscosity as it is now [mass/(length time)].  Velocities are not numbers before it
  /// is set.
  virtual void set_viscosity(double viscosity) = 0;

  /// Collective.  The particles that the following calls move.
  virtual void bind(const Particles &particles) = 0;
  /// Collective.  Like bind(), but for near() alone.
  virtual void bind_near(const Particles &particles) = 0;

  /// Collective.  After bind(): keeps the pairs, for several calls of apply().
  virtual void keep_pairs() {}

  /// Collective.  velocity := M forces.
  virtual void apply(const PseForces &forces, const PseVelocities &velocity) = 0;
  /// Collective.  After keep_pairs(): velocity.strain := that of M forces, where stresslets alone
  /// act; the rest of `velocity` is arbitrary.
  virtual void apply_stresslets(const PseForces &forces, const PseVelocities &velocity)
  {
    apply(forces, velocity);
  }
  /// Collective.  velocity := M forces + noise.
  virtual PseReport fluctuate(const PseForces &forces, const PseNoise &noise,
                              const PseVelocities &velocity) = 0;
  /// Collective.  The far part alone: velocity := M_w forces + its noise.
  virtual void far(const PseForces &forces, const PseNoise &noise,
                   const PseVelocities &velocity) = 0;
  /// Collective.  The near part alone: by_forces := M_r forces, by_noise := its noise.
  virtual PseReport near(const PseForces &forces, const PseNoise &noise,
                         const NearVelocities &velocity) = 0;

  virtual double pairs() const = 0;    ///< kept by the last evaluation with noise, on this rank
  virtual std::size_t grid_memory() const = 0;    ///< bytes on this rank
  virtual std::size_t particle_memory() const = 0;
};

using HostPseMobility = PseMobility<NeighborView>;

/// What a mobility on the host works with.
struct PseHost {
  Comm comm;
  FftSetup setup = FftEffort::estimate;
  GhostExchange *exchange = nullptr;    ///< needed with several ranks; must outlive the mobility
  const Workers &workers = Workers::one();
};

/// Collective.  A mobility on the host, in the plan's precision.  More than lanczos_limit
/// iterations throw NotConverged.
std::unique_ptr<HostPseMobility> make_pse(const PsePlan &plan, int lanczos_limit,
                                          const PseHost &host);

/// velocity := 0
template <class Execution, class Neighbors> void clear(const Execution &execution,
                                                       const PseParticles<Neighbors> &particles,
                                                       const PseVelocities &velocity)
{
  execution.for_each("bdh::clear", dof * particles.count, Clear{velocity.linear});
  if (velocity.angular)
    execution.for_each("bdh::clear", dof * particles.count, Clear{velocity.angular});
  if (velocity.strain)
    execution.for_each("bdh::clear", strain_numbers * particles.count, Clear{velocity.strain});
}

/// The mobility, written once for host and device.  Parts makes the two halves and names the
/// execution; HostPse in pse/mobility.cpp shows what it must have.
template <class Real, class Parts> class SplitEwald
    : public PseMobility<typename Parts::Neighbors> {
 public:
  using Particles = PseParticles<typename Parts::Neighbors>;

  SplitEwald(const PsePlan &plan, int lanczos_limit, const Parts &parts) :
      parts_(parts), plan_(plan), wave_(parts.template wave<Real>(plan)),
      near_(plan, lanczos_limit, parts)
  {}

  const PsePlan &plan() const override { return plan_; }

  bool change_radius(const PsePlan &plan) override
  {
    if (!same_but_for_radius(plan, plan_)) return false;
    const std::array<long, 3> n = plan_.n;    // there may be room in it for the cell
    plan_ = plan;
    plan_.n = n;
    wave_->set_radii(plan);
    near_.set_radii(plan);
    return true;
  }

  bool set_cell(const Cell &cell) override
  {
    const bool too_coarse = !wave_->fits(cell);
    if (too_coarse) {
      plan_.n = roomier_grid(plan_, cell);
      wave_.reset();
      wave_ = parts_.template wave<Real>(plan_);
    }
    wave_->set_cell(cell);
    volume_ = cell.volume();
    return too_coarse;
  }

  void set_viscosity(double viscosity) override { viscosity_ = viscosity; }

  void bind(const Particles &particles) override
  {
    bind_near(particles);
    wave_->bind(particles);
  }

  void bind_near(const Particles &particles) override
  {
    particles_ = particles;
    near_.bind(particles);
  }

  void apply(const PseForces &forces, const PseVelocities &velocity) override
  {
    if (!forces.act) return clear(parts_.execution(), particles_, velocity);
    wave_->apply(forces, {}, viscosity_, velocity);
    near_.apply(forces, viscosity_, velocity);
  }

  void apply_stresslets(const PseForces &forces, const PseVelocities &velocity) override
  {
    if constexpr (Parts::have_strains) {
      wave_->apply_stresslets(forces, viscosity_, velocity);
      near_.apply_stresslets(forces, viscosity_, velocity);
    } else {
      apply(forces, velocity);
    }
  }

  void keep_pairs() override { near_.keep_pairs(); }

  PseReport fluctuate(const PseForces &forces, const PseNoise &noise,
                      const PseVelocities &velocity) override
  {
    if (!noise.acts()) {
      apply(forces, velocity);
      return {};
    }
    wave_->apply(forces, noise, viscosity_, velocity);
    near_.apply_and_keep(forces, viscosity_, velocity);
    return apply_root(noise, velocity);
  }

  void far(const PseForces &forces, const PseNoise &noise, const PseVelocities &velocity) override
  {
    wave_->apply(forces, noise, viscosity_, velocity);
  }

  PseReport near(const PseForces &forces, const PseNoise &noise,
                 const NearVelocities &velocity) override
  {
    clear(parts_.execution(), particles_, velocity.by_forces);
    near_.apply_and_keep(forces, viscosity_, velocity.by_forces);
    if (!noise.acts()) return {};
    clear(parts_.execution(), particles_, velocity.by_noise);
    return apply_root(noise, velocity.by_noise);
  }

  double pairs() const override { return near_.pairs(); }
  std::size_t grid_memory() const override { return wave_->grid_memory(); }
  std::size_t particle_memory() const override { return wave_->particle_memory() + near_.memory(); }

 private:
  using Wave = typename Parts::template Wave<Real>;

  /// velocity += the noise of the near part
  PseReport apply_root(const PseNoise &noise, const PseVelocities &velocity)
  {
    const LanczosReport root = near_.apply_root(noise, viscosity_, volume_, velocity);
    return {root.iterations, 0, root.error};
  }

  Parts parts_;
  PsePlan plan_;
  std::unique_ptr<Wave> wave_;
  NearMobility<Real, Parts> near_;
  Particles particles_;
  double volume_ = 1.0, viscosity_ = std::numeric_limits<double>::quiet_NaN();
};

}    // namespace bdh
#endif
