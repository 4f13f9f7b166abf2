// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/moving_walls.h"

namespace bdh {

bool LinearFlow::flows() const
{
  for (std::size_t d = 0; d < 3; ++d)
    if (at_origin[d] != 0.0 || gradient[d] != 0.0) return true;
  return false;
}

AddLinearFlow LinearFlow::adder(const double *x, double *velocity) const
{
  return {axis,
          origin,
          {at_origin[0], at_origin[1], at_origin[2]},
          {gradient[0], gradient[1], gradient[2]},
          x,
          velocity};
}

std::array<double, strain_numbers> LinearFlow::strain() const
{
  double G[3][3] = {};
  for (int c = 0; c < 3; ++c) G[c][axis] = gradient[c];
  std::array<double, strain_numbers> numbers{};
  strain_of(G, numbers.data());
  return numbers;
}

AddToEach LinearFlow::turner(double *omega) const
{
  // Half the curl of a velocity with this gradient along `axis`: half the cross product.
  AddToEach add{{0.0, 0.0, 0.0}, omega};
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  add.v[a] = -0.5 * gradient[b];
  add.v[b] = 0.5 * gradient[a];
  return add;
}

namespace {

/// Adds shear along x, at rest in the wall opposite to an open face, or in the middle between two.
void add_shear(const Grid &grid, double rate, LinearFlow &flow)
{
  const int d = flow.axis;
  const bool below = grid.boundary[d][0] == Boundary::open,
             above = grid.boundary[d][1] == Boundary::open;
  flow.origin = below && above ? 0.5 * (grid.box_lo(d) + grid.box_hi(d))
                : below        ? grid.box_hi(d)
                               : grid.box_lo(d);
  flow.gradient[0] = below && !above ? -rate : rate;
}

/// The flow between the only two walls of a slit.
LinearFlow slit_flow(const WallOptions &walls, const Grid &grid)
{
  LinearFlow flow;
  for (int d = 0; d < grid.dim; ++d) {
    if (!grid.walled(d)) continue;
    const WallOptions::Wall &lower = walls.face[d][0];
    const WallOptions::Wall &upper = walls.face[d][1];
    flow.axis = d;
    flow.origin = grid.lo[d];
    flow.at_origin = lower.kind == Boundary::noslip ? lower.velocity : upper.velocity;
    if (lower.kind == Boundary::noslip && upper.kind == Boundary::noslip)
      for (std::size_t c = 0; c < 3; ++c)
        flow.gradient[c] = (upper.velocity[c] - lower.velocity[c]) / grid.length[d];
  }
  return flow;
}

}    // namespace

WallMotion::WallMotion(const WallOptions &walls, const Grid &grid, IbKernel kernel,
                       double shear_rate) :
    grid_(grid),
    kernel_(kernel)
{
  if (!walls.any_moves() && !(grid.opens() && shear_rate != 0.0)) return;
  solved_ = grid.walled_axes() > 1;
  if (!solved_) {
    flow_ = slit_flow(walls, grid);
    if (grid.opens() && shear_rate != 0.0) add_shear(grid, shear_rate, flow_);
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t side = 0; side < 2; ++side)
      velocity_[axis][side] = walls.face[axis][side].velocity;
}

}    // namespace bdh
