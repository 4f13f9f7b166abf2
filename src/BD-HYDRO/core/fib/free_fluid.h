// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What is left of the fluid without hydrodynamic interactions: friction and noise of each
/// particle.
#ifndef BDH_FIB_FREE_FLUID_H
#define BDH_FIB_FREE_FLUID_H

#include "base/bytes_of.h"
#include "base/comm.h"
#include "base/particles.h"
#include "base/rng_kernel.h"
#include "base/ssize.h"
#include "base/vectors.h"
#include "base/workers.h"
#include "fib/spread.h"
#include "fib/step_kernel.h"
#include "grid/grid.h"
#include "stokes/solver.h"

#include <cmath>

namespace bdh {

/// Collective.  The mobility of a single particle times the viscosity: in three dimensions that of
/// a sphere of the kernel's hydrodynamic radius in an unbounded fluid, 1/(6 pi a) [1/length].  In
/// two dimensions there is none without a box, so it is that of a particle in the middle of this
/// one.
double self_mobility(const Grid &grid, IbKernel kernel, const Comm &comm);
/// The same for rotation, with the rotational radius: 1/(8 pi a^3) [1/length^3], and in two
/// dimensions 1/(4 pi a^2) [1/length^2], which needs no box.
double self_rotation(const Grid &grid, IbKernel kernel);

/// Takes the place of FibFluid in BrownianStep: u = mu F + sqrt(2 kT mu/dt) z, where the normals z
/// of a particle are those that bd/pse draws for it, too, and the same for torques and angular
/// velocities.
template <class Place> class FreeFluid {
 public:
  using Execution = typename Place::Execution;
  using Vector = typename Place::ParticleVector;

  /// self, self_turning: times the viscosity, as self_mobility() and self_rotation() give them.
  /// particles: those of the steps.
  FreeFluid(const Grid &grid, double self, double self_turning,
            const ParticlesOf<Vector> &particles, const Comm &comm,
            const Workers &workers = Workers::one()) :
      execution_(workers),
      grid_(grid), self_(self), self_turning_(self_turning), particles_(particles), comm_(comm)
  {}

  const Grid &grid() const { return grid_; }
  const Execution &execution() const { return execution_; }
  const Comm &comm() const { return comm_; }

  /// Throws BadParticle for a position beyond a wall.
  void bind(const double *x, long n, double slack = 0.0) const
  {
    Place::check_positions(execution_, grid_, x, n, slack);
  }
  /// Forces := 0
  void clear()
  {
    force_.resize(0);
    torque_.resize(0);
  }
  /// Forces += force.  The mobility is the same everywhere, so there is no drift.
  void spread(const double *force, double) { add(force, force_); }
  /// Torques += torque.
  void spread_torque(const double *torque) { add(torque, torque_); }
  /// Velocities := those of the forces and of the noise.
  void solve(const StokesProblem &problem)
  {
    move(problem, self_ / problem.viscosity, Stream::lanczos, grid_.dim, force_, velocity_);
    if (ssize(torque_) > 0)
      move(problem, self_turning_ / problem.viscosity, Stream::lanczos_rotation, 3, torque_,
           omega_);
  }
  /// velocity (3 n) := that of each particle
  void interpolate(double *velocity) const { copy(velocity_, velocity); }
  /// omega (3 n) := the angular velocity of each particle
  void angular_velocity(double *omega) const
  {
    copy(omega_, omega);
    if (grid_.dim == 2) execution_.for_each("bdh::in_plane", particles_.size(), KeepThird{omega});
  }

  SolveReport report() const { return {}; }
  std::size_t grid_memory() const { return 0; }
  std::size_t particle_memory() const { return bytes_of(force_, velocity_, torque_, omega_); }

 private:
  void add(const double *load, Vector &loads) const
  {
    const std::size_t size = 3 * particles_.size();
    if (loads.size() != size) {
      loads.resize(size);
      execution_.clear(loads);
    }
    combine(execution_, 1.0, loads.data(), 1.0, load, loads);
  }
  void move(const StokesProblem &problem, double mobility, Stream stream, int dim,
            const Vector &loads, Vector &velocity) const
  {
    velocity.resize(loads.size());
    scale(execution_, mobility, loads, velocity);
    for (const StressDraw &draw : problem.stress)
      execution_.for_draws("bdh::free_noise", particles_.size(),
                           {problem.seed, stream, problem.step, draw.stage}, particles_.ids(),
                           AddNormals{draw.weight * std::sqrt(2.0 * problem.kT_over_dt * mobility),
                                      dim, velocity.data()});
  }
  void copy(const Vector &from, double *to) const
  {
    execution_.for_each("bdh::free_interpolate", ssize(from), Scale<double>{1.0, from.data(), to});
  }

  Execution execution_;
  Grid grid_;
  double self_, self_turning_;
  const ParticlesOf<Vector> &particles_;
  Comm comm_;
  Vector force_, velocity_, torque_, omega_;
};

}    // namespace bdh
#endif
