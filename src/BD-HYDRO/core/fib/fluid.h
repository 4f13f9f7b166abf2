// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluid of the fluctuating immersed boundary method: spread, solve, interpolate.
/// [FIB eq. (19), (28), (30)]
///
///     M = J L^-1 S / eta            M^(1/2) = (eta dV)^(-1/2) J L^-1 D~
#ifndef BDH_FIB_FLUID_H
#define BDH_FIB_FLUID_H

#include "base/bytes_of.h"
#include "base/moments_kernel.h"
#include "base/phases.h"
#include "fib/host.h"
#include "grid/slabs.h"

namespace bdh {

/// The fluid and the particles in it.  Particles come and go through bind(); between two calls J
/// and S are those at the positions of the last one.
template <class Place> class FibFluid {
 public:
  using Vector = typename Place::Vector;
  using Execution = typename Place::Execution;

  /// Collective.  moments: what is spread and interpolated besides forces and velocities.
  FibFluid(const Grid &grid, IbKernel kernel, FftEffort effort, const Comm &comm,
           const Workers &workers = Workers::one(), Moments moments = Moments::none) :
      execution_(workers),
      moments_(moments), order_(solver_order(grid)), box_(grid), grid_(order_(grid)), comm_(comm),
      stokes_(grid_, comm, effort, workers),
      spreader_(grid_, stokes_.slab(), kernel, workers, moments != Moments::none),
      exchange_(comm, stokes_.slab(), grid_.n[grid_.slow_axis()], 3),
      tensors_(comm, stokes_.slab(), grid_.n[grid_.slow_axis()], strain_numbers)
  {
    for (int d = 0; d < grid.dim; ++d) field_[d].resize(stokes_.allocation());
  }

  const Grid &grid() const { return box_; }
  const Execution &execution() const { return execution_; }

  /// Collective.  J, S := those at positions x (3 n; any periodic image).  Throws BadParticle.  For
  /// `slack` see check_positions().
  void bind(const double *x, long n, double slack = 0.0)
  {
    const PhaseScope binding(Phase::spread);
    Place::check_positions(execution_, box_, x, n, slack);
    particles_ = n;
    x = in_order(x, n);
    const int slow = grid_.slow_axis();
    const auto plane = [this, x, slow](long i) { return spreader_.first_plane(x[3 * i + slow]); };
    exchange_.plan(n, plane, spreader_.plane_reach());
    if (moments_ == Moments::stresslet) tensors_.plan(n, plane, spreader_.plane_reach());
    spreader_.bind(exchange_.bring(x), exchange_.count());
  }

  /// True on one rank, which counts what all ranks do together.
  bool is_first_rank() const { return comm_.rank() == 0; }
  /// Collective.  True if `mine` is true on any rank.
  bool any(bool mine) const { return any_rank(comm_, mine); }
  /// Collective.  The sum over ranks.
  double sum(double mine) const { return comm_.sum(mine); }

  /// f := 0
  void clear()
  {
    const PhaseScope clearing(Phase::spread);
    for (int d = 0; d < grid_.dim; ++d) execution_.clear(field_[d]);
  }

  /// Collective.  f += S F + kT div S, with F in `force` (3 n) and kT in drift_kT, where 0 leaves
  /// the thermal drift out.
  void spread(const double *force, double drift_kT)
  {
    const PhaseScope spreading(Phase::spread);
    force = in_order(force, particles_);
    spreader_.spread(exchange_.bring(force), drift_kT, view());
  }

  /// Collective.  f += the divergence of S with energies of each particle's own (3 n).
  void spread_drift(const double *kT)
  {
    const PhaseScope spreading(Phase::spread);
    spreader_.spread_drift(exchange_.bring(in_order(kT, particles_)), view());
  }

  /// Collective.  f += half the curl of the kernel times the torques (3 n).
  void spread_torque(const double *torque)
  {
    const PhaseScope spreading(Phase::spread);
    if (!order_.is_natural()) {
      reordered_.resize(3 * particles_);
      execution_.for_each("bdh::reorder", particles_,
                          ReorderAxial{order_.reorder(torque, reordered_.data()), -1.0});
      torque = reordered_.data();
    }
    spreader_.spread_torque(exchange_.bring(torque), view());
  }

  /// Collective.  f -= divergence of the kernel times the stresslets (strain_numbers per particle).
  void spread_stresslet(const double *stresslet)
  {
    const PhaseScope spreading(Phase::spread);
    if (!order_.is_natural()) {
      reordered_.resize(strain_numbers * particles_);
      execution_.for_each("bdh::reorder", particles_,
                          ReorderTensors{order_.reorder(stresslet, reordered_.data())});
      stresslet = reordered_.data();
    }
    spreader_.spread_stresslet(tensors_.bring(stresslet), view());
  }

  /// Collective.  f := v
  void solve(StokesProblem problem)
  {
    const PhaseScope solving(Phase::transform);
    const std::array<double, 3> force = problem.body_force;
    order_(force, problem.body_force);
    report_ = stokes_.solve(view(), problem);
  }

  /// The report of the last solve, with the axes of the box.
  SolveReport report() const
  {
    SolveReport r = report_;
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t side = 0; side < 2; ++side)
        order_(report_.wall_force[order_.axis[d]][side], r.wall_force[d][side]);
    return r;
  }

  /// Collective.  velocity (3 n) := J v
  void interpolate(double *velocity)
  {
    const PhaseScope interpolating(Phase::interpolate);
    reordered_.resize(order_.is_natural() ? 0 : (3 * particles_));
    double *u = order_.is_natural() ? velocity : reordered_.data();
    spreader_.interpolate(view(), exchange_.parts(u));
    exchange_.take_back(u);
    if (!order_.is_natural())
      execution_.for_each("bdh::reorder", particles_, order_.reorder(u, velocity));
  }

  /// Collective.  omega (3 n) := half the average of the curl of v.
  void angular_velocity(double *omega)
  {
    const PhaseScope interpolating(Phase::interpolate);
    reordered_.resize(order_.is_natural() ? 0 : (3 * particles_));
    double *w = order_.is_natural() ? omega : reordered_.data();
    spreader_.angular_velocity(view(), exchange_.parts(w));
    exchange_.take_back(w);
    if (!order_.is_natural())
      execution_.for_each("bdh::reorder", particles_, ReorderAxial{order_.reorder(w, omega), -1.0});
  }

  /// Collective.  strain (strain_numbers per particle) := the average rates of strain of v, and
  /// omega (3 n) := what angular_velocity() gives.
  void gradient(double *strain, double *omega)
  {
    const PhaseScope interpolating(Phase::interpolate);
    const bool natural = order_.is_natural();
    reordered_.resize(natural ? 0 : (3 + strain_numbers) * particles_);
    double *e = natural ? strain : reordered_.data(),
           *w = natural ? omega : reordered_.data() + strain_numbers * particles_;
    spreader_.gradient(view(), tensors_.parts(e), exchange_.parts(w));
    tensors_.take_back(e);
    exchange_.take_back(w);
    if (natural) return;
    execution_.for_each("bdh::reorder", particles_, ReorderTensors{order_.reorder(e, strain)});
    execution_.for_each("bdh::reorder", particles_, ReorderAxial{order_.reorder(w, omega), -1.0});
  }

  /// This rank's part of the velocity field, after solve(), with the axes in the solver's order.
  const Vector &component(int d) const { return field_[d]; }
  Slab slab() const { return stokes_.slab(); }

  /// Bytes on this rank: those of the grid, and those of the particles.
  std::size_t grid_memory() const
  {
    return grid_.dim * stokes_.allocation() * sizeof(typename Place::Real) + stokes_.memory();
  }
  std::size_t particle_memory() const
  {
    return spreader_.memory() + exchange_.memory() + tensors_.memory() + bytes_of(reordered_);
  }

 private:
  using Field = FieldOf<typename Place::Real>;

  Field view()
  {
    Field v{};
    for (int d = 0; d < grid_.dim; ++d) v[d] = field_[d].data();
    return v;
  }

  /// Returns the vectors v of n particles in the solver's order of axes.  The result is valid until
  /// the next call.
  const double *in_order(const double *v, long n)
  {
    if (order_.is_natural()) return v;
    reordered_.resize(3 * n);
    execution_.for_each("bdh::reorder", n, order_.reorder(v, reordered_.data()));
    return reordered_.data();
  }

  Execution execution_;
  Moments moments_;
  AxisOrder order_;
  Grid box_, grid_;    // with the axes as the user has them, and in the solver's order
  Comm comm_;
  typename Place::Stokes stokes_;
  typename Place::Spreader spreader_;
  SlabExchange exchange_, tensors_;    // tensors_: of stresslets and rates of strain
  Vector field_[3];
  typename Place::ParticleVector reordered_;
  SolveReport report_;
  long particles_ = 0;
};

}    // namespace bdh
#endif
