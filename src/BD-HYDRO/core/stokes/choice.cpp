// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/choice.h"

#include "base/errors.h"
#include "stokes/box.h"
#include "stokes/periodic.h"
#include "stokes/slit.h"

#include <stdexcept>
#include <type_traits>
#include <utility>

namespace bdh {

Grid AxisOrder::operator()(const Grid &grid) const
{
  Grid g = grid;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t from = axis[d];
    g.n[d] = grid.n[from];
    g.lo[d] = grid.lo[from];
    g.length[d] = grid.length[from];
    g.boundary[d] = grid.boundary[from];
    g.beyond[d] = grid.beyond[from];
    g.left_out[d] = grid.left_out[from];
  }
  return g;
}

SolverKind solver_kind(const Grid &grid)
{
  if (grid.walled_axes() == 0) return SolverKind::periodic;
  if (grid.walled_axes() == 1) return SolverKind::slit;
  bool friction = false;
  for (const auto &axis : grid.boundary)
    for (const Boundary kind : axis) friction = is_noslip_wall(kind) || friction;
  return friction ? SolverKind::box : SolverKind::slip_box;
}

AxisOrder solver_order(const Grid &grid)
{
  AxisOrder order;
  if (solver_kind(grid) != SolverKind::slit) return order;
  for (int d = 0; d < grid.dim; ++d)
    if (grid.walled(d)) std::swap(order.axis[d], order.axis[grid.slow_axis()]);
  return order;
}

template <class Real> AnyStokes<Real>::AnyStokes(const Grid &grid, const Comm &comm,
                                                 const FftSetup &setup, const Workers &workers) :
    solver_(choose_solver<Real>(
        grid, [&] { return std::make_unique<PeriodicStokes<Real>>(grid, comm, setup, workers); },
        [&] { return std::make_unique<SlitStokes<Real>>(grid, comm, setup, workers); },
        [&]() -> std::unique_ptr<StokesSolver<Real>> {
          if (setup.share > 1)
            throw InvalidOption("pencils", setup.share,
                                "a box with walls in several directions has only slabs: give 1 "
                                "for slabs, or the word auto");
          if constexpr (std::is_same<Real, double>::value)
            return std::make_unique<BoxStokes>(grid, comm, setup.effort, workers);
          throw std::logic_error("AnyStokes: boxes with walls are solved in double precision");
        }))
{}

template class AnyStokes<float>;
template class AnyStokes<double>;

}    // namespace bdh
