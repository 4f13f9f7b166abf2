/// Fluctuating Stokes equations with walls in any directions, by conjugate gradients for the pressure.
#ifndef BDH_BOX_H
#define BDH_BOX_H

#include "bdh_lanczos.h"
#include "bdh_stokes.h"
#include "bdh_trig.h"

namespace bdh {

/// Walls, no-slip or free-slip, in any directions.
///
/// Without pressure the velocity is u = (-L)^-1 f/eta + random velocity, exact by fast transforms of each component; the
/// pressure makes v = u + (-L)^-1 D^T q free of divergence,
///     D (-L)^-1 D^T q = -D u.
/// This Schur complement has eigenvalues between the inf-sup constant of the box and 1, whatever the spacing, so plain
/// conjugate gradients need as many iterations on every grid.  Each costs one forward and one backward transform of
/// every component.  Where no wall is no-slip it is the identity, and the first iteration is exact.
/// The random velocity is drawn in mode space: (-L)^-1/2 z has the covariance of (-L)^-1 D~ W, since D~ D~* = -L.
class BoxStokes : public StokesSolver {
 public:
  /// Collective.
  BoxStokes(const Grid &grid, const Comm &comm, FftEffort effort, const Workers &workers = Workers::one());
  Slab slab() const override { return transforms_.slab(); }
  std::size_t allocation() const override { return transforms_.allocation(); }
  /// Throws NotConverged.
  SolveReport solve(const FieldView &field, const StokesProblem &problem) override;
  std::size_t memory() const override;

 private:
  void unconstrained_velocity(const FieldView &field, const StokesProblem &problem);
  void inverse_laplacian(const FieldView &field, double factor, const StokesProblem *noise);
  void solve_modes(const FieldView &field, double factor, const StokesProblem *noise, const Slab &block) const;
  void gradient(AlignedVector &cells, const FieldView &field);
  void divergence(const FieldView &field, AlignedVector &cells);
  double dot(const AlignedVector &a, const AlignedVector &b) const;
  void add_moving_walls(const FieldView &field, const StokesProblem &problem);
  WallVectors wall_forces(const FieldView &velocity, const StokesProblem &problem) const;
  /// Is the face of component d at `at` the lower wall, and no unknown?
  bool on_wall(int d, const long *at) const { return grid_.walled(d) && at[d] == 0; }
  template <class Action> void for_rows_of(long begin, long end, Action action) const;
  template <class Action> void for_rows(Action action) const;
  template <class Action> void for_wall_cells(Action action) const;

  Grid grid_;
  Comm comm_;
  const Workers &workers_;
  HostAlgebra<double> algebra_;
  WalledTransforms transforms_;
  long pitch_, plane_;
  AlignedVector step_[3];                          // (-L)^-1 D^T d
  AlignedVector pressure_, residual_, direction_, image_, halo_;
};

}    // namespace bdh
#endif
