// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/free_fluid.h"

#include "base/constants.h"
#include "fib/fluid.h"

namespace bdh {

namespace {

/// u_x of a particle in the middle of the box with a force along x, in a fluid of viscosity 1.
double mobility_in_the_middle(const Grid &grid, IbKernel kernel, const Comm &comm)
{
  FibFluid<FibOnHost> fluid(grid, kernel, FftEffort::estimate, comm);
  const double force[3] = {1.0, 0.0, 0.0};
  double x[3] = {0.0, 0.0, 0.0}, u[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < grid.dim; ++d) x[d] = grid.lo[d] + 0.5 * grid.length[d];
  fluid.bind(x, comm.rank() == 0 ? 1 : 0);
  fluid.clear();
  fluid.spread(force, 0.0);
  StokesProblem problem;
  problem.viscosity = 1.0;
  problem.tolerance = 1e-10;
  fluid.solve(problem);
  fluid.interpolate(u);
  return comm.sum(comm.rank() == 0 ? u[0] : 0.0);
}

}    // namespace

double self_mobility(const Grid &grid, IbKernel kernel, const Comm &comm)
{
  if (grid.dim == 2) return mobility_in_the_middle(grid, kernel, comm);
  return 1.0 / (6.0 * pi * hydrodynamic_radius(kernel, grid));
}

double self_rotation(const Grid &grid, IbKernel kernel)
{
  const double a = rotational_radius(kernel, grid);
  return grid.dim == 2 ? 1.0 / (4.0 * pi * a * a) : 1.0 / (8.0 * pi * a * a * a);
}

}    // namespace bdh
