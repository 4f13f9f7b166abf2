// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/grid_choice.h"

#include "base/errors.h"
#include "grid/fft.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace bdh {

namespace {

/// The 2,3,5,7-smooth number nearest to `wanted` that is at least `least`.
long nearest_fast_size(double wanted, long least)
{
  const long above = next_fast_size(std::max<long>(least, std::ceil(wanted)));
  for (long below = std::max<long>(least, std::floor(wanted)); below >= least; --below)
    if (next_fast_size(below) == below)
      // Ratios are compared, since the radius is proportional to 1/n.
      return wanted / below < above / wanted ? below : above;
  return above;
}

[[noreturn]] void refuse_large_grid(double radius)
{
  throw InvalidOption(
      "radius", radius,
      "it needs more than 32768 cells along an axis of the box: use a larger radius");
}

/// Cells along an axis of the box without open faces.
long cells_along(const FibOptions &options, const Grid &g, int d)
{
  const int width = kernel_width(options.kernel);
  const double wanted = g.length[d] * radius_over_spacing(options.kernel, g.dim) / options.radius;
  if (options.grid_given()) {
    if (options.cells[d] < width)
      throw InvalidOption(std::string("grid n") + "xyz"[d], options.cells[d],
                          std::string("kernel ") + kernel_name(options.kernel) +
                              " needs at least " + std::to_string(width) + " cells per axis");
    return options.cells[d];
  }
  if (wanted < width)
    throw InvalidOption("radius", options.radius,
                        std::string("the box is only ") + std::to_string(wanted) +
                            " grid cells wide along " + "xyz"[d] + ": kernel " +
                            kernel_name(options.kernel) + " needs " + std::to_string(width) +
                            "; use a smaller radius, a smaller kernel or a larger box");
  if (wanted > most_cells) refuse_large_grid(options.radius);
  return nearest_fast_size(wanted, width);
}

/// Lets an axis with an open face have the spacing of the other axes: as many cells as contain the
/// box, beginning at the wall if there is one.
void fill_with_cubes(int d, Grid &g)
{
  double h = 1.0;
  for (int other = 0; other < g.dim; ++other)
    if (other != d) h *= g.dim == 3 ? std::sqrt(g.h(other)) : g.h(other);
  const double cells = std::ceil(g.length[d] / h - 1e-9);
  if (cells > most_cells) refuse_large_grid(h);
  g.n[d] = std::max(1L, static_cast<long>(cells));
  const double more = g.n[d] * h - g.length[d];
  const bool lower = g.boundary[d][0] == Boundary::open, upper = g.boundary[d][1] == Boundary::open;
  g.beyond[d] = {lower ? upper ? 0.5 * more : more : 0.0, upper ? lower ? 0.5 * more : more : 0.0};
  g.lo[d] -= g.beyond[d][0];
  g.length[d] = g.n[d] * h;
}

}    // namespace

Grid choose_grid(const FibOptions &options, int dim, const std::array<double, 3> &lo,
                 const std::array<double, 3> &length, const std::array<bool, 3> &periodic)
{
  Grid g;
  g.dim = dim;
  g.boundary = options.walls.boundary(dim, periodic);
  if (dim == 2 && options.grid_given() && options.cells[2] != 1)
    throw InvalidOption("grid nz", options.cells[2], "must be 1 in a two-dimensional simulation");
  if (dim == 2 && options.body_force[2] != 0.0)
    throw InvalidOption("force fz", options.body_force[2],
                        "must be 0 in a two-dimensional simulation");
  for (int d = 0; d < dim; ++d) {
    g.lo[d] = lo[d];
    g.length[d] = length[d];
    if (!g.has(Boundary::open, d))
      g.n[d] = cells_along(options, g, d);
    else if (options.grid_given())
      g.n[d] = options.cells[d];
  }
  for (int d = 0; d < dim && !options.grid_given(); ++d)
    if (g.has(Boundary::open, d)) fill_with_cubes(d, g);
  return beyond_open_faces(g, rows_beyond(options.kernel));
}

double anisotropy(const Grid &grid)
{
  double least = grid.h(0), most = grid.h(0);
  for (int d = 1; d < grid.dim; ++d) {
    least = std::min(least, grid.h(d));
    most = std::max(most, grid.h(d));
  }
  return most / least - 1.0;
}

}    // namespace bdh
