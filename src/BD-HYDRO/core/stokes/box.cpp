// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/box.h"

#include "base/bytes_of.h"
#include "grid/slabs.h"
#include "stokes/noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

BoxGrid box_grid(const Grid &grid)
{
  BoxGrid b{};
  b.dim = grid.dim;
  b.cell_volume = grid.cell_volume();
  long stride = 1;
  for (int d = 0; d < 3; ++d) {
    b.n[d] = grid.n[d];
    b.stride[d] = stride;
    stride *= d == 0 ? 2 * grid.half() : grid.n[d];
    b.h[d] = grid.h(d);
    b.inv_h[d] = 1.0 / grid.h(d);
    b.walled[d] = grid.walled(d);
    for (int side = 0; side < 2; ++side) b.noslip[d][side] = is_noslip_wall(grid.boundary[d][side]);
  }
  return b;
}

BoxModeScales box_mode_scales(const Grid &grid, double factor, const StokesProblem *noise)
{
  const double norm = transform_norm(grid);
  return {factor, norm,
          noise ? std::sqrt(2.0 * 2.0 * noise->kT_over_dt /
                            (noise->viscosity * grid.cell_volume() * norm))
                : 0.0};
}

BoxStokes::BoxStokes(const Grid &grid, const Comm &comm, FftEffort effort, const Workers &workers) :
    grid_(grid), box_(box_grid(grid)), comm_(comm), workers_(workers),
    transforms_(grid, comm, effort, workers), pitch_(2 * grid.half()),
    plane_(grid.dim == 3 ? pitch_ * grid.n[1] : pitch_),
    pressure_(grid.dim, std::max(1L, slab().count * plane_), transforms_.allocation(),
              HostExecution(workers)),
    halo_(plane_, 0.0)
{}

std::size_t BoxStokes::memory() const
{
  return transforms_.memory() + pressure_.memory() + bytes_of(halo_);
}

/// Calls action(offset of the row, y, plane of the box) for each row in this rank's planes
/// begin .. end - 1.
template <class Action> void BoxStokes::for_rows_of(long begin, long end, Action action) const
{
  const long rows = grid_.dim == 3 ? grid_.n[1] : 1, start = slab().start;
  for (long p = begin; p < end; ++p)
    for (long y = 0; y < rows; ++y) action(p * plane_ + y * pitch_, y, start + p);
}

/// The same for all rows of this rank, shared among the workers.
template <class Action> void BoxStokes::for_rows(Action action) const
{
  workers_.for_ranges(
      slab().count, [&](long begin, long end) { for_rows_of(begin, end, action); }, plane_);
}

/// Calls action(axis, side, offset, cell of the box) for each cell of this rank that touches a
/// wall, one after the other.
template <class Action> void BoxStokes::for_wall_cells(Action action) const
{
  for (int axis = 0; axis < grid_.dim; ++axis)
    for (int side = 0; side < 2 && grid_.walled(axis); ++side) {
      const long layer = side ? grid_.n[axis] - 1 : 0;
      for_rows_of(0, slab().count, [&](long row, long y, long plane) {
        long at[3] = {axis == 0 ? layer : 0, grid_.dim == 3 ? y : plane, plane};
        if (axis != 0 && at[axis] != layer) return;
        const long end = axis == 0 ? layer + 1 : grid_.n[0];
        for (; at[0] < end; ++at[0]) action(axis, side, row + at[0], at);
      });
    }
}

/// In mode space: field := factor (-L)^-1 field, plus amplitude (-L)^-1/2 z if there is noise.
/// Both are divided by the norm of the transforms.
void BoxStokes::solve_modes(const FieldView &field, double factor, const StokesProblem *noise,
                            const Slab &block) const
{
  static_assert(WalledTransforms::widest <= strip, "a block's row is a strip");
  const Slab columns = transforms_.columns();
  const long place = columns.start + block.start;
  const int slow = grid_.slow_axis();
  const BoxModeScales scales = box_mode_scales(grid_, factor, noise);
  // For each column: the part of the eigenvalue and of the weight that comes from the axes within
  // a plane.  Both are 0 where there is no unknown.
  double lambda[3][strip], weight[3][strip];
  for (int d = 0; d < grid_.dim; ++d) {
    const AxisModes &x = transforms_.modes(d, 0), &y = transforms_.modes(d, 1);
    for (long i = 0; i < block.count; ++i) {
      const std::size_t jx = (place + i) % pitch_, jy = (place + i) / pitch_;
      const bool in_row = jx < x.weight.size();
      lambda[d][i] = in_row ? x.eigenvalue[jx] + (grid_.dim == 3 ? y.eigenvalue[jy] : 0.0) : 0.0;
      weight[d][i] = in_row ? x.weight[jx] * (grid_.dim == 3 ? y.weight[jy] : 1.0) : 0.0;
    }
  }
  StripNormals<double> normals;
  for (long plane = 0; plane < grid_.n[slow]; ++plane) {
    const uint64_t base = plane * plane_ + place;
    if (noise)
      draw_strip(
          *noise, [base](long i) { return base + i; }, block.count, normals);
    for (int d = 0; d < grid_.dim; ++d) {
      const AxisModes &z = transforms_.modes(d, slow);
      double *f = field[d] + plane * columns.count + block.start;
      for (long i = 0; i < block.count; ++i)
        f[i] =
            solve_box_mode(scales, lambda[d][i] + z.eigenvalue[plane],
                           weight[d][i] * z.weight[plane], f[i], noise != nullptr, normals.z[d][i]);
    }
  }
}

/// field := factor (-L)^-1 field, plus a random velocity unless `noise` is null.
void BoxStokes::inverse_laplacian(const FieldView &field, double factor, const StokesProblem *noise)
{
  transforms_.solve(field, [&](const Slab &block) { solve_modes(field, factor, noise, block); });
}

void BoxStokes::unconstrained_velocity(const FieldView &field, const StokesProblem &problem)
{
  for (int d = 0; d < grid_.dim; ++d)
    for_rows([&](long row, long y, long plane) {
      const long at[3] = {0, grid_.dim == 3 ? y : plane, plane};
      double *f = field[d] + row;
      const double body_force = problem.body_force[d];
      for (long i = 0; i < grid_.n[0]; ++i)
        f[i] = face_force(box_, d, d == 0 ? i : at[d], f[i], body_force);
    });
  if (problem.wall_velocity != WallVectors{})
    for_wall_cells([&](int axis, int side, long place, const long *at) {
      add_moving_wall(box_, axis, problem.wall_velocity[axis][side].data(), problem.viscosity, at,
                      place, field.data());
    });
  inverse_laplacian(field, 1.0 / problem.viscosity, problem.noisy() ? &problem : nullptr);
}

/// field := D^T cells on every face that is not a wall.
void BoxStokes::gradient(const double *cells, const FieldView &field)
{
  const int slow = grid_.slow_axis();
  fetch_plane(comm_, slab(), grid_.n[slow], plane_, cells, Neighbour::before, halo_.data());
  for_rows([&](long row, long y, long plane) {
    const double *c = cells + row;
    const long at[3] = {0, grid_.dim == 3 ? y : plane, plane};
    double *fx = field[0] + row;
    const double inner = box_.inv_h[0];
    for (long i = 1; i < grid_.n[0]; ++i) fx[i] = bdh::gradient(inner, c[i - 1], c[i]);
    fx[0] = bdh::gradient(box_.face_scale(0, 0), c[box_.before(0, 0)], c[0]);
    for (int d = 1; d < grid_.dim; ++d) {
      const bool in_halo = d == slow && plane == slab().start;
      const double *before =
          in_halo ? halo_.data() + (grid_.dim == 3 ? y * pitch_ : 0) : c + box_.before(d, at[d]);
      double *f = field[d] + row;
      const double scale = box_.face_scale(d, at[d]);
      for (long i = 0; i < grid_.n[0]; ++i) f[i] = bdh::gradient(scale, before[i], c[i]);
    }
  });
}

/// cells := D field
void BoxStokes::divergence(const FieldView &field, double *cells)
{
  const int slow = grid_.slow_axis();
  fetch_plane(comm_, slab(), grid_.n[slow], plane_, field[slow], Neighbour::after, halo_.data());
  for_rows([&](long row, long y, long plane) {
    double *c = cells + row;
    const double *fx = field[0] + row;
    const long at[3] = {0, grid_.dim == 3 ? y : plane, plane}, last = grid_.n[0] - 1;
    const double inv_hx = box_.inv_h[0];
    for (long i = 0; i < last; ++i) c[i] = bdh::divergence(inv_hx, fx[i], fx[i + 1]);
    c[last] = bdh::divergence(inv_hx, fx[last], fx[last + box_.after(0, last)]);
    for (int d = 1; d < grid_.dim; ++d) {
      const bool in_halo = d == slow && plane + 1 == slab().start + slab().count;
      const double *f = field[d] + row;
      const double *after =
          in_halo ? halo_.data() + (grid_.dim == 3 ? y * pitch_ : 0) : f + box_.after(d, at[d]);
      const double inv_h = box_.inv_h[d];
      for (long i = 0; i < grid_.n[0]; ++i) c[i] += bdh::divergence(inv_h, f[i], after[i]);
    }
  });
}

double BoxStokes::steepest(const FieldView &field) const
{
  const long cells = slab().count * (grid_.dim == 3 ? grid_.n[0] * grid_.n[1] : grid_.n[0]);
  const HostExecution execution(workers_);
  if (grid_.dim == 2)
    return execution.sum("bdh::steepest", cells, Steepness<2>{box_, {field[0], field[1], nullptr}});
  return execution.sum("bdh::steepest", cells, Steepness<3>{box_, {field[0], field[1], field[2]}});
}

WallVectors BoxStokes::wall_forces(const FieldView &velocity, const StokesProblem &problem) const
{
  WallVectors force{};
  for_wall_cells([&](int axis, int side, long place, const long *at) {
    const std::size_t a = axis, s = side;
    add_wall_force(box_, axis, side, problem.wall_velocity[a][s].data(), problem.viscosity, at,
                   place, pressure_.pressure()[place], velocity.data(), force[a][s].data());
  });
  return force;
}

SolveReport BoxStokes::solve(const FieldView &field, const StokesProblem &problem)
{
  unconstrained_velocity(field, problem);
  SolveReport report = pressure_.run(*this, field, problem.tolerance);
  report.wall_force = wall_forces(field, problem);
  return report;
}

}    // namespace bdh
