// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Positively split Ewald: velocities M F and random velocities of covariance 2 kT M/dt.   [PSE
/// sec. II]
///
///     M = M_r + M_w,   M^(1/2) dW = M_r^(1/2) dW_1 + M_w^(1/2) dW_2                        (14),
///     (18)
#ifndef BDH_PSE_MOBILITY_H
#define BDH_PSE_MOBILITY_H

#include "base/bytes_of.h"
#include "base/comm.h"
#include "base/lanczos.h"
#include "base/phases.h"
#include "grid/fft.h"
#include "pse/plan.h"
#include "pse/real_space.h"
#include "pse/rpy.h"
#include "pse/step_kernel.h"
#include "pse/wave_space.h"

#include <cmath>
#include <memory>

namespace bdh {

/// What one evaluation did.
struct PseReport {
  int iterations = 0;    ///< of Lanczos; 0 without noise
  double root_error =
      0.0;    ///< estimated error of the noise by Lanczos, relative to the whole noise
};

/// The plan's grid with some room for this cell, so that a box that grows or leans does not ask for
/// a new one at every step.
std::array<long, 3> roomier_grid(const PsePlan &plan, const Cell &cell);
/// The whole noise of a particle has variance (2 kT/dt) M_ii: what errors are to be small beside,
/// in units of sqrt((2 kT/dt)/(6 pi viscosity a)).
double whole_noise(const PsePlan &plan, double volume);
LanczosOptions root_options(const PsePlan &plan, double volume, int limit);

/// The mobility at fixed positions, wherever the arrays of the particles are.  Neighbors: a
/// neighbour list, as it is there.
template <class Neighbors> class PseMobility {
 public:
  virtual ~PseMobility() = default;

  virtual const PsePlan &plan() const = 0;
  /// Collective.  The cell as it is now.  Makes a new grid, and returns true, when the old one is
  /// too coarse for it.
  virtual bool set_cell(const Cell &cell) = 0;

  /// Collective.  Positions of the particles (3 n), and the neighbours as seen from the same
  /// positions, which must stay where they are; `all` counts particles of other ranks too.
  virtual void bind(const double *x, long n, const Neighbors &neighbors, long all) = 0;
  /// Collective.  velocity (3 n) := M force.
  virtual void apply(const double *force, double viscosity, double *velocity) = 0;
  /// Collective.  velocity (3 n) := M force + noise; forces: false (on all ranks) leaves the force
  /// out.  The noise of particle i in real space is a function of id[i], noise.seed and noise.step.
  virtual PseReport fluctuate(bool forces, const double *force, const PseNoise &noise,
                              const uint64_t *id, double viscosity, double *velocity) = 0;

  /// Collective.  The far part alone, after bind(): velocity (3 n) := M_w force + noise, if
  /// kT_over_dt > 0.
  virtual void far(bool forces, const double *force, const PseNoise &noise, double viscosity,
                   double *velocity) = 0;
  /// As bind(), for near() alone.
  virtual void bind_near(long n, const Neighbors &neighbors, long all) = 0;
  /// Collective.  The near part alone: drift (3 n) := M_r force, or 0 without forces, and random (3
  /// n) := M_r^(1/2) z in units of the mobility's root, if kT_over_dt > 0.  z is a function of id,
  /// seed, step and stage.
  virtual PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage,
                         const uint64_t *id, double viscosity, double *drift, double *random) = 0;

  virtual double pairs() const = 0;    ///< kept by the last evaluation with noise, on this rank
  virtual std::size_t grid_memory() const = 0;    ///< bytes on this rank
  virtual std::size_t particle_memory() const = 0;
};

using HostPseMobility = PseMobility<NeighborView>;

/// Collective.  On the host, in the plan's precision.  exchange is used when the run has several
/// ranks, and must outlive the mobility.
std::unique_ptr<HostPseMobility> make_pse(const PsePlan &plan, const Comm &comm, FftEffort effort,
                                          int lanczos_limit, GhostExchange *exchange,
                                          const Workers &workers = Workers::one());

/// M_r as Lanczos sees it.
template <class Pairs, class Parts> class RealSpaceOperator {
 public:
  using Vector = typename Pairs::Vector;
  RealSpaceOperator(const Pairs &pairs, const Parts &parts) : pairs_(pairs), parts_(parts) {}
  std::size_t size() const { return 4 * pairs_.owned(); }
  std::size_t full_size() const { return 4 * pairs_.all(); }
  void apply(Vector &v, Vector &u) const
  {
    parts_.fill_ghosts(v.data());
    pairs_.apply(v, u);
  }
  double sum(double mine) const { return parts_.sum(mine); }

 private:
  const Pairs &pairs_;
  const Parts &parts_;
};

/// Written once for host and device.  Parts makes the two halves and names the execution; HostPse
/// in pse/mobility.cpp says what it has.
template <class Real, class Parts> class SplitEwald
    : public PseMobility<typename Parts::Neighbors> {
 public:
  using Neighbors = typename Parts::Neighbors;

  SplitEwald(const PsePlan &plan, int lanczos_limit, const Parts &parts) :
      parts_(parts), plan_(plan), limit_(lanczos_limit), wave_(parts.template wave<Real>(plan)),
      pairs_(parts.template pairs<Real>(plan)), root_(parts.execution())
  {}

  const PsePlan &plan() const override { return plan_; }

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

  void bind(const double *x, long n, const Neighbors &neighbors, long all) override
  {
    bind_near(n, neighbors, all);
    wave_->bind(x, n);
  }

  void bind_near(long n, const Neighbors &neighbors, long all) override
  {
    neighbors_ = neighbors;
    owned_ = n;
    all_ = all;
  }

  void apply(const double *force, double viscosity, double *velocity) override
  {
    wave_->apply(true, force, nullptr, viscosity, velocity);
    const PhaseScope phase(Phase::pairs);
    load(force);
    pairs_.bind_and_apply(neighbors_, owned_, all_, force_, product_);
    add(self_mobility(viscosity), velocity);
  }

  PseReport fluctuate(bool forces, const double *force, const PseNoise &noise, const uint64_t *id,
                      double viscosity, double *velocity) override
  {
    wave_->apply(forces, force, &noise, viscosity, velocity);
    apply_pairs(forces, force, viscosity, velocity);
    return apply_root(noise, 0, id, viscosity, velocity);
  }

  void far(bool forces, const double *force, const PseNoise &noise, double viscosity,
           double *velocity) override
  {
    wave_->apply(forces, force, noise.kT_over_dt > 0.0 ? &noise : nullptr, viscosity, velocity);
  }

  PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage,
                 const uint64_t *id, double viscosity, double *drift, double *random) override
  {
    parts_.execution().for_each("bdh::clear", 3 * owned_, Clear{drift});
    apply_pairs(forces, force, viscosity, drift);
    if (!(noise.kT_over_dt > 0.0)) return {};    // random is null on a rank without particles
    parts_.execution().for_each("bdh::clear", 3 * owned_, Clear{random});
    return apply_root({PseNoise::unit, noise.seed, noise.step}, stage, id, viscosity, random);
  }

  double pairs() const override { return pairs_.pairs(); }
  std::size_t grid_memory() const override { return wave_->grid_memory(); }
  std::size_t particle_memory() const override
  {
    return wave_->particle_memory() + pairs_.memory() + root_.memory() +
           bytes_of(force_, product_, random_);
  }

 private:
  using Wave = typename Parts::template Wave<Real>;
  using Pairs = typename Parts::template Pairs<Real>;
  using Operator = RealSpaceOperator<Pairs, Parts>;
  using Vector = typename Pairs::Vector;

  /// Keeps the pairs for Lanczos; velocity += M_r force.
  void apply_pairs(bool forces, const double *force, double viscosity, double *velocity)
  {
    const PhaseScope phase(Phase::pairs);
    pairs_.bind(neighbors_, owned_, all_);
    if (forces) {
      load(force);
      pairs_.apply(force_, product_);
      add(self_mobility(viscosity), velocity);
    }
    parts_.execution().fence();
  }

  /// velocity += sqrt(2 kT/dt) M_r^(1/2) z
  PseReport apply_root(const PseNoise &noise, uint32_t stage, const uint64_t *id, double viscosity,
                       double *velocity)
  {
    const PhaseScope phase(Phase::lanczos);
    random_.resize(4 * owned_);
    parts_.execution().for_each(
        "bdh::draw", owned_,
        DrawVector<Real>{{noise.seed, Stream::lanczos, noise.step, stage}, id, random_.data()});
    Operator M(pairs_, parts_);
    const LanczosReport root =
        root_.apply(M, random_, root_options(plan_, volume_, limit_), product_);
    add(std::sqrt(2.0 * noise.kT_over_dt * self_mobility(viscosity)), velocity);
    return {root.iterations, root.error / whole_noise(plan_, volume_)};
  }

  double self_mobility(double viscosity) const { return free_mobility(plan_.radius, viscosity); }

  /// force_ := force, with ghosts
  void load(const double *force)
  {
    force_.resize(4 * all_);
    parts_.execution().for_each("bdh::load", owned_, LoadVector<Real>{force, force_.data()});
    parts_.fill_ghosts(force_.data());
  }
  /// velocity += factor product_
  void add(double factor, double *velocity) const
  {
    parts_.execution().for_each("bdh::add", owned_,
                                AddVector<Real>{factor, product_.data(), velocity});
    parts_.execution().fence();
  }

  Parts parts_;
  PsePlan plan_;
  int limit_;
  std::unique_ptr<Wave> wave_;
  Pairs pairs_;
  LanczosRoot<Operator, typename Parts::Execution> root_;
  Neighbors neighbors_;
  long owned_ = 0, all_ = 0;
  double volume_ = 1.0;
  Vector force_, product_, random_;
};

}    // namespace bdh
#endif
