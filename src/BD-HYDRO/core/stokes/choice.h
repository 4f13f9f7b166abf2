// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Chooses the cheapest solver that is exact for the walls of a box.
#ifndef BDH_STOKES_CHOICE_H
#define BDH_STOKES_CHOICE_H

#include "grid/fft.h"
#include "grid/position_kernel.h"
#include "stokes/solver.h"

#include <memory>
#include <stdexcept>

namespace bdh {

/// A `periodic` box has no walls and needs only Fourier modes.  A `slit` has walls or open faces on
/// one axis, the slow one.  A `box` has walls on several axes, some of them no-slip.  A `slip_box`
/// has only free-slip walls on several axes.
enum class SolverKind { periodic, slit, box, slip_box };

/// Order of the axes that the solver of a box requires: the walls of a slit belong on the slow
/// axis.  It exchanges two axes, so it is its own inverse.
struct AxisOrder {
  /// axis[internal] = axis of the box, and vice versa.
  std::array<int, 3> axis{0, 1, 2};

  bool is_natural() const { return axis[0] == 0 && axis[1] == 1; }
  Grid operator()(const Grid &grid) const;
  /// Copies three numbers for each particle from one order to the other.
  ReorderAxes reorder(const double *from, double *to) const
  {
    return {{axis[0], axis[1], axis[2]}, from, to};
  }
  /// Reorders a single vector.
  void operator()(const std::array<double, 3> &from, std::array<double, 3> &to) const
  {
    reorder(from.data(), to.data())(0);
  }
};

/// Throws std::logic_error if there are open faces on one of several axes with walls or such faces,
/// which no solver can have.
SolverKind solver_kind(const Grid &grid);
AxisOrder solver_order(const Grid &grid);

/// Returns what the maker for the grid's kind of walls returns: periodic(), slit() or box(). Throws
/// std::logic_error for a kind that has none.
template <class Real, class Periodic, class Slit, class Box>
auto choose_solver(const Grid &grid, Periodic periodic, Slit slit, Box box)
    -> std::unique_ptr<StokesSolver<Real>>
{
  switch (solver_kind(grid)) {
  case SolverKind::periodic: return periodic();
  case SolverKind::slit: return slit();
  case SolverKind::box:
  case SolverKind::slip_box: return box();
  }
  throw std::logic_error("a kind of walls is missing in choose_solver()");
}

/// True if several ranks may share a slab of the grid: transforms of a box know only slabs.
inline bool can_have_pencils(const Grid &grid)
{
  const SolverKind kind = solver_kind(grid);
  return grid.dim == 3 && (kind == SolverKind::periodic || kind == SolverKind::slit);
}

/// True if there is a solver in single precision.  The iteration for the pressure of a box needs
/// double.
inline bool solves_in_single(const Grid &grid)
{
  const SolverKind kind = solver_kind(grid);
  return kind == SolverKind::periodic || kind == SolverKind::slit;
}

/// The solver that suits the walls of the grid, whose axes must be in solver_order().
template <class Real> class AnyStokes : public StokesSolver<Real> {
 public:
  /// Collective.  Throws std::logic_error if Real is float and solves_in_single() is false.
  AnyStokes(const Grid &grid, const Comm &comm, const FftSetup &setup,
            const Workers &workers = Workers::one());
  const GridParts &parts() const override { return solver_->parts(); }
  std::size_t allocation() const override { return solver_->allocation(); }
  SolveReport solve(const FieldOf<Real> &field, const StokesProblem &problem) override
  {
    return solver_->solve(field, problem);
  }
  std::size_t memory() const override { return solver_->memory(); }

 private:
  std::unique_ptr<StokesSolver<Real>> solver_;
};

extern template class AnyStokes<float>;
extern template class AnyStokes<double>;

}    // namespace bdh
#endif
