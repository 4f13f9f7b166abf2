// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluid of the fluctuating immersed boundary method: spread, solve, interpolate.
/// [FIB eq. (19), (28), (30)]
///
///     M = J L^-1 S / eta            M^(1/2) = (eta dV)^(-1/2) J L^-1 D~
#ifndef BDH_FIB_FLUID_H
#define BDH_FIB_FLUID_H

#include "base/comm.h"
#include "base/moments_kernel.h"
#include "base/phases.h"
#include "fib/host.h"
#include "fib/solver_axes.h"

namespace bdh {

/// The fluid and the particles in it.  Particles come and go through bind(); between two calls J
/// and S are those at the positions of the last one.
template <class Place> class FibFluid {
 public:
  using Vector = typename Place::Vector;
  using Execution = typename Place::Execution;

  /// Collective.  moments: what is spread and interpolated besides forces and velocities.
  FibFluid(const Grid &grid, IbKernel kernel, const FftSetup &setup, const Comm &comm,
           const Workers &workers = Workers::one(), Moments moments = Moments::none) :
      execution_(workers),
      axes_(solver_order(grid), execution_), box_(grid), grid_(axes_.order()(grid)), comm_(comm),
      stokes_(grid_, comm, setup, workers),
      spreader_(grid_, stokes_.slab(), kernel, workers, moments != Moments::none),
      exchange_(stokes_.parts(), 3), tensors_(exchange_, strain_numbers)
  {
    for (int d = 0; d < grid.dim; ++d) field_[d].resize(stokes_.allocation());
  }

  const Grid &grid() const { return box_; }
  const Execution &execution() const { return execution_; }
  /// The ranks that share the fluid.
  const Comm &comm() const { return comm_; }

  /// Collective.  J, S := those at positions x (3 n; any periodic image).  Throws BadParticle.  For
  /// `slack` see check_positions().
  void bind(const double *x, long n, double slack = 0.0)
  {
    const PhaseScope binding(Phase::spread);
    Place::check_positions(execution_, box_, x, n, slack);
    particles_ = n;
    x = axes_.bring(PolarVectors(), x, n);
    exchange_.plan(n, spreader_.first_lines(x), spreader_.reach());
    spreader_.bind(exchange_.bring(x), exchange_.count());
  }

  /// f := 0
  void clear()
  {
    const PhaseScope clearing(Phase::spread);
    for (int d = 0; d < grid_.dim; ++d)
      if (stokes_.parts().pencils())
        stokes_.parts().clear(field_[d].data());
      else
        execution_.clear(field_[d]);
  }

  /// Collective.  f += S F + kT div S, with F in `force` (3 n) and kT in drift_kT, where 0 leaves
  /// the thermal drift out.
  void spread(const double *force, double drift_kT)
  {
    const PhaseScope spreading(Phase::spread);
    force = axes_.bring(PolarVectors(), force, particles_);
    spreader_.spread(exchange_.bring(force), drift_kT, view());
  }

  /// Collective.  f += the divergence of S with energies of each particle's own (3 n).
  void spread_drift(const double *kT)
  {
    const PhaseScope spreading(Phase::spread);
    kT = axes_.bring(PolarVectors(), kT, particles_);
    spreader_.spread_drift(exchange_.bring(kT), view());
  }

  /// Collective.  f += half the curl of the kernel times the torques (3 n).
  void spread_torque(const double *torque)
  {
    const PhaseScope spreading(Phase::spread);
    torque = axes_.bring(AxialVectors(), torque, particles_);
    spreader_.spread_torque(exchange_.bring(torque), view());
  }

  /// Collective.  f -= divergence of the kernel times the stresslets (strain_numbers per particle).
  void spread_stresslet(const double *stresslet)
  {
    const PhaseScope spreading(Phase::spread);
    stresslet = axes_.bring(TracelessTensors(), stresslet, particles_);
    spreader_.spread_stresslet(tensors_.bring(stresslet), view());
  }

  /// Collective.  f := v
  void solve(StokesProblem problem)
  {
    const PhaseScope solving(Phase::transform);
    const std::array<double, 3> force = problem.body_force;
    axes_.order()(force, problem.body_force);
    report_ = stokes_.solve(view(), problem);
  }

  /// The report of the last solve, with the axes of the box.
  SolveReport report() const
  {
    const AxisOrder &order = axes_.order();
    SolveReport r = report_;
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t side = 0; side < 2; ++side)
        order(report_.wall_force[order.axis[d]][side], r.wall_force[d][side]);
    return r;
  }

  /// Collective.  velocity (3 n) := J v
  void interpolate(double *velocity)
  {
    const PhaseScope interpolating(Phase::interpolate);
    double *const u = axes_.parts(PolarVectors(), velocity, particles_);
    spreader_.interpolate(view(), exchange_.parts(u));
    exchange_.take_back(u);
    axes_.take_back(PolarVectors(), velocity, particles_);
  }

  /// Collective.  omega (3 n) := half the average of the curl of v.
  void angular_velocity(double *omega)
  {
    const PhaseScope interpolating(Phase::interpolate);
    double *const w = axes_.parts(AxialVectors(), omega, particles_);
    spreader_.angular_velocity(view(), exchange_.parts(w));
    exchange_.take_back(w);
    axes_.take_back(AxialVectors(), omega, particles_);
  }

  /// Collective.  strain (strain_numbers per particle) := the average rates of strain of v, and
  /// omega (3 n) := what angular_velocity() gives.
  void gradient(double *strain, double *omega)
  {
    const PhaseScope interpolating(Phase::interpolate);
    double *const e = axes_.parts(TracelessTensors(), strain, particles_);
    double *const w = axes_.parts(AxialVectors(), omega, particles_);
    spreader_.gradient(view(), tensors_.parts(e), exchange_.parts(w));
    tensors_.take_back(e);
    exchange_.take_back(w);
    axes_.take_back(TracelessTensors(), strain, particles_);
    axes_.take_back(AxialVectors(), omega, particles_);
  }

  /// This rank's part of the velocity field, after solve(), with the axes in the solver's order.
  const Vector &component(int d) const { return field_[d]; }
  const GridParts &parts() const { return stokes_.parts(); }
  Slab slab() const { return parts().planes(); }

  /// Bytes on this rank: those of the grid, and those of the particles.
  std::size_t grid_memory() const
  {
    return grid_.dim * stokes_.allocation() * sizeof(typename Place::Real) + stokes_.memory();
  }
  std::size_t particle_memory() const
  {
    return spreader_.memory() + exchange_.memory() + tensors_.memory() + axes_.memory();
  }

 private:
  using Field = FieldOf<typename Place::Real>;

  Field view()
  {
    Field v{};
    for (int d = 0; d < grid_.dim; ++d) v[d] = field_[d].data();
    return v;
  }

  Execution execution_;
  SolverAxes<Execution, typename Place::ParticleVector> axes_;
  Grid box_, grid_;    // with the axes as the user has them, and in the solver's order
  Comm comm_;
  typename Place::Stokes stokes_;
  typename Place::Spreader spreader_;
  typename Place::Exchange exchange_, tensors_;    // tensors_: of stresslets and rates of strain
  Vector field_[3];
  SolveReport report_;
  long particles_ = 0;
};

}    // namespace bdh
#endif
