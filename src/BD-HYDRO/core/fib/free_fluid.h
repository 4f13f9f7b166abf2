// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What is left of the fluid without hydrodynamic interactions: friction and noise of each
/// particle.
#ifndef BDH_FIB_FREE_FLUID_H
#define BDH_FIB_FREE_FLUID_H

#include "base/bytes_of.h"
#include "base/comm.h"
#include "base/particles.h"
#include "base/ssize.h"
#include "base/workers.h"
#include "fib/spread.h"
#include "grid/grid.h"
#include "stokes/solver.h"

#include <cmath>

namespace bdh {

/// Collective.  The mobility of a single particle times the viscosity: in three dimensions that of
/// a sphere of the kernel's hydrodynamic radius in an unbounded fluid, 1/(6 pi a) [1/length].  In
/// two dimensions there is none without a box, so it is that of a particle in the middle of this
/// one.
double self_mobility(const Grid &grid, IbKernel kernel, const Comm &comm);

/// Takes the place of FibFluid in BrownianStep: u = mu F + sqrt(2 kT mu/dt) z, where the normals z
/// of a particle are those that bd/pse draws for it, too.
template <class Place> class FreeFluid {
 public:
  using Execution = typename Place::Execution;
  using Vector = typename Place::ParticleVector;

  /// self: times the viscosity, as self_mobility() gives it.  particles: those of the steps.
  FreeFluid(const Grid &grid, double self, const ParticlesOf<Vector> &particles, const Comm &comm,
            const Workers &workers = Workers::one()) :
      execution_(workers),
      grid_(grid), self_(self), particles_(particles), comm_(comm)
  {}

  const Grid &grid() const { return grid_; }
  const Execution &execution() const { return execution_; }
  bool is_first_rank() const { return comm_.rank() == 0; }
  /// Collective.  True if `mine` is true on any rank.
  bool any(bool mine) const { return any_rank(comm_, mine); }

  /// Throws BadParticle for a position beyond a wall.
  void bind(const double *x, long n, double slack = 0.0) const
  {
    Place::check_positions(execution_, grid_, x, n, slack);
  }
  /// Forces := 0
  void clear() { force_.resize(0); }
  /// Forces += force.  The mobility is the same everywhere, so there is no drift.
  void spread(const double *force, double)
  {
    const std::size_t size = 3 * particles_.size();
    if (force_.size() != size) {
      force_.resize(size);
      execution_.clear(force_);
    }
    execution_.for_each("bdh::free_force", ssize(force_),
                        Combine{1.0, force_.data(), 1.0, force, force_.data()});
  }
  /// Velocities := those of the forces and of the noise.
  void solve(const StokesProblem &problem)
  {
    const double mobility = self_ / problem.viscosity;
    velocity_.resize(force_.size());
    execution_.for_each("bdh::free_velocity", ssize(velocity_),
                        Scale<double>{mobility, force_.data(), velocity_.data()});
    for (const StressDraw &draw : problem.stress)
      execution_.for_each("bdh::free_noise", particles_.size(),
                          AddNormals{{problem.seed, Stream::lanczos, problem.step, draw.stage},
                                     particles_.ids(),
                                     draw.weight * std::sqrt(2.0 * problem.kT_over_dt * mobility),
                                     grid_.dim,
                                     velocity_.data()});
  }
  /// velocity (3 n) := that of each particle
  void interpolate(double *velocity) const
  {
    execution_.for_each("bdh::free_interpolate", ssize(velocity_),
                        Scale<double>{1.0, velocity_.data(), velocity});
  }

  SolveReport report() const { return {}; }
  std::size_t grid_memory() const { return 0; }
  std::size_t particle_memory() const { return bytes_of(force_, velocity_); }

 private:
  Execution execution_;
  Grid grid_;
  double self_;
  const ParticlesOf<Vector> &particles_;
  Comm comm_;
  Vector force_, velocity_;
};

}    // namespace bdh
#endif
