// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fluctuating Stokes equations with walls in any direction; conjugate gradients find the pressure.
#ifndef BDH_STOKES_BOX_H
#define BDH_STOKES_BOX_H

#include "base/execution.h"
#include "grid/trig.h"
#include "stokes/box_kernel.h"
#include "stokes/pressure.h"
#include "stokes/solver.h"

namespace bdh {

BoxGrid box_grid(const Grid &grid);
/// Returns the scales for factor (-L)^-1 f, plus a random velocity unless `noise` is null.
BoxModeScales box_mode_scales(const Grid &grid, double factor, const StokesProblem *noise);

/// Walls, no-slip or free-slip, in any direction.
///
/// Without pressure the velocity is u = (-L)^-1 f/eta + random velocity, which fast transforms of
/// each component give exactly.  The pressure makes v = u + (-L)^-1 D^T q divergence-free:
///     D (-L)^-1 D^T q = -D u.
/// The eigenvalues of this Schur complement lie between the inf-sup constant of the box and 1 for
/// any spacing, so plain conjugate gradients need the same number of iterations on every grid.
/// Each iteration costs one forward and one backward transform of every component.  Without
/// no-slip walls the complement is the identity, and the first iteration is exact.
///
/// The random velocity is drawn in mode space: (-L)^-1/2 z has the covariance of (-L)^-1 D~ W,
/// since D~ D~* = -L.
class BoxStokes : public StokesSolver<double> {
 public:
  /// Collective.
  BoxStokes(const Grid &grid, const Comm &comm, FftEffort effort,
            const Workers &workers = Workers::one());
  const GridParts &parts() const override { return transforms_.parts(); }
  std::size_t allocation() const override { return transforms_.allocation(); }
  /// Throws NotConverged.
  SolveReport solve(const FieldView &field, const StokesProblem &problem) override;
  std::size_t memory() const override;

 private:
  template <class, class> friend class PressureIteration;
  void unconstrained_velocity(const FieldView &field, const StokesProblem &problem);
  void inverse_laplacian(const FieldView &field, double factor, const StokesProblem *noise);
  void solve_modes(const FieldView &field, double factor, const StokesProblem *noise,
                   const Slab &block) const;
  void gradient(const double *cells, const FieldView &field);
  void divergence(const FieldView &field, double *cells);
  double steepest(const FieldView &field) const;
  WallVectors wall_forces(const FieldView &velocity, const StokesProblem &problem) const;
  template <class Action> void for_rows_of(long begin, long end, Action action) const;
  template <class Action> void for_rows(Action action) const;
  template <class Action> void for_wall_cells(Action action) const;

  double sum(double mine) const { return comm_.sum(mine); }

  Grid grid_;
  BoxGrid box_;
  Comm comm_;
  const Workers &workers_;
  WalledTransforms transforms_;
  long pitch_, plane_;
  PressureIteration<AlignedVector, HostExecution> pressure_;
  AlignedVector halo_;
};

}    // namespace bdh
#endif
