/// The fluid of the fluctuating immersed boundary method: spread, solve, interpolate.       [FIB eq. (19), (28), (30)]
///
///     M = J L^-1 S / eta            M^(1/2) = (eta dV)^(-1/2) J L^-1 D~
#ifndef BDH_FIB_H
#define BDH_FIB_H

#include "bdh_host.h"

#include <algorithm>

namespace bdh {

/// Particles come and go through bind(); between two calls J and S are frozen at those positions.
template <class Backend> class FibFluid {
 public:
  using Vector = typename Backend::Vector;

  /// Collective.
  FibFluid(const Grid &grid, IbKernel kernel, FftEffort effort, const Comm &comm) :
      grid_(grid), comm_(comm), stokes_(grid, comm, effort), spreader_(grid, stokes_.slab(), kernel),
      exchange_(comm, plane_owners(comm, stokes_.slab(), grid.n[grid.slow_axis()]))
  {
    for (int d = 0; d < grid.dim; ++d) field_[d].resize(stokes_.allocation());
  }

  const Grid &grid() const { return grid_; }

  /// Collective.  J, S := at x (3 n; any periodic image).  Throws BadParticle.
  void bind(const double *x, long n)
  {
    check_positions(grid_, x, n);
    if (comm_.size() > 1) {
      first_plane_.resize(static_cast<std::size_t>(n));
      for (long i = 0; i < n; ++i) first_plane_[i] = spreader_.first_plane(x[3 * i + grid_.slow_axis()]);
      exchange_.plan(first_plane_, spreader_.plane_reach());
      spreader_.bind(exchange_.forward(x, 3), exchange_.received());
    } else {
      spreader_.bind(x, n);
    }
  }

  /// f := 0
  void clear()
  {
    for (int d = 0; d < grid_.dim; ++d) std::fill(field_[d].begin(), field_[d].end(), 0.0);
  }

  /// Collective.  f += S F + kT div S.  force: 3 n; drift_kT = 0 for no thermal drift.
  void spread(const double *force, double drift_kT)
  {
    spreader_.spread(comm_.size() > 1 ? exchange_.forward(force, 3) : force, drift_kT, view());
  }

  /// Collective.  f := v
  void solve(const StokesProblem &problem) { stokes_.solve(view(), problem); }

  /// Collective.  velocity (3 n) := J v
  void interpolate(double *velocity)
  {
    if (comm_.size() == 1) return spreader_.interpolate(view(), velocity);
    partial_.resize(static_cast<std::size_t>(3 * exchange_.received()));
    spreader_.interpolate(view(), partial_.data());
    exchange_.reverse_sum(partial_.data(), 3, velocity);
  }

  /// This rank's part of the velocity field, after solve().
  const Vector &component(int d) const { return field_[d]; }
  Slab slab() const { return stokes_.slab(); }

  /// Bytes on this rank: of the grid, and of the particles.
  std::size_t grid_memory() const
  {
    return static_cast<std::size_t>(grid_.dim) * stokes_.allocation() * sizeof(double) + stokes_.memory();
  }
  std::size_t particle_memory() const
  {
    return spreader_.memory() + exchange_.memory() + partial_.capacity() * sizeof(double);
  }

 private:
  FieldView view()
  {
    FieldView v{};
    for (int d = 0; d < grid_.dim; ++d) v[d] = field_[d].data();
    return v;
  }

  Grid grid_;
  Comm comm_;
  typename Backend::Stokes stokes_;
  typename Backend::Spreader spreader_;
  SlabExchange exchange_;
  Vector field_[3];
  Vector partial_;
  std::vector<long> first_plane_;
};

}    // namespace bdh
#endif
