#include "bdh_box.h"

#include "bdh_errors.h"
#include "bdh_stokes_noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

BoxStokes::BoxStokes(const Grid &grid, const Comm &comm, FftEffort effort, const Workers &workers) :
    grid_(grid), comm_(comm), workers_(workers), algebra_(workers), transforms_(grid, comm, effort, workers), pitch_(2 * grid.half()),
    plane_(grid.dim == 3 ? pitch_ * grid.n[1] : pitch_)
{
  for (int d = 0; d < grid.dim; ++d) step_[d].resize(transforms_.allocation());
  const std::size_t cells = static_cast<std::size_t>(std::max(1L, slab().count * plane_));
  for (AlignedVector *v : {&pressure_, &residual_, &direction_, &image_}) v->assign(cells, 0.0);
  halo_.assign(static_cast<std::size_t>(plane_), 0.0);
}

std::size_t BoxStokes::memory() const
{
  return transforms_.memory() +
      (static_cast<std::size_t>(grid_.dim) * transforms_.allocation() + 4 * pressure_.size() + halo_.size()) * sizeof(double);
}

/// Calls action(place of the row, y, plane of the box) for the rows of planes begin .. end - 1 of this rank.
template <class Action> void BoxStokes::for_rows_of(long begin, long end, Action action) const
{
  const long rows = grid_.dim == 3 ? grid_.n[1] : 1, start = slab().start;
  for (long p = begin; p < end; ++p)
    for (long y = 0; y < rows; ++y) action(p * plane_ + y * pitch_, y, start + p);
}

/// The same for all rows of this rank, by all workers.
template <class Action> void BoxStokes::for_rows(Action action) const
{
  workers_.for_ranges(slab().count, [&](long begin, long end) { for_rows_of(begin, end, action); }, plane_);
}

/// Calls action(axis, side, place, cell of the box) for all cells of this rank that touch a wall, in turn.
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

/// field, in mode space, /= -L times factor; noise: plus amplitude (-L)^-1/2 z.  Both divided by the transforms' norm.
void BoxStokes::solve_modes(const FieldView &field, double factor, const StokesProblem *noise, const Slab &block) const
{
  static_assert(WalledTransforms::widest <= strip, "a block's row is a strip");
  const Slab columns = transforms_.columns();
  const long place = columns.start + block.start;
  const int slow = grid_.slow_axis();
  const double norm = transforms_.norm();
  // The strip's normals have variance 1/2.
  const double amplitude =
      noise ? std::sqrt(2.0 * 2.0 * noise->kT_over_dt / (noise->viscosity * grid_.cell_volume() * norm)) : 0.0;
  // Of each column, what the axes of a plane add to a mode's eigenvalue and give to its weight; 0 where no unknown is.
  double lambda[3][strip], weight[3][strip];
  for (int d = 0; d < grid_.dim; ++d) {
    const AxisModes &x = transforms_.modes(d, 0), &y = transforms_.modes(d, 1);
    for (long i = 0; i < block.count; ++i) {
      const std::size_t jx = static_cast<std::size_t>((place + i) % pitch_), jy = static_cast<std::size_t>((place + i) / pitch_);
      const bool in_row = jx < x.weight.size();
      lambda[d][i] = in_row ? x.eigenvalue[jx] + (grid_.dim == 3 ? y.eigenvalue[jy] : 0.0) : 0.0;
      weight[d][i] = in_row ? x.weight[jx] * (grid_.dim == 3 ? y.weight[jy] : 1.0) : 0.0;
    }
  }
  StripNormals normals;
  for (long plane = 0; plane < grid_.n[slow]; ++plane) {
    const uint64_t base = static_cast<uint64_t>(plane * plane_ + place);
    if (noise) draw_strip(*noise, [base](long i) { return base + static_cast<uint64_t>(i); }, block.count, normals);
    for (int d = 0; d < grid_.dim; ++d) {
      const AxisModes &z = transforms_.modes(d, slow);
      double *f = field[d] + plane * columns.count + block.start;
      for (long i = 0; i < block.count; ++i) {
        const double l = lambda[d][i] + z.eigenvalue[plane], w = weight[d][i] * z.weight[plane];
        if (l > 0.0 && w != 0.0)
          f[i] = f[i] * (factor / (l * norm)) + (noise ? amplitude / std::sqrt(l * w) * normals.z[d][i] : 0.0);
        else
          f[i] = 0.0;
      }
    }
  }
}

/// field := factor (-L)^-1 field, plus the random velocity of `noise`.
void BoxStokes::inverse_laplacian(const FieldView &field, double factor, const StokesProblem *noise)
{
  transforms_.solve(field, [&](const Slab &block) { solve_modes(field, factor, noise, block); });
}

void BoxStokes::unconstrained_velocity(const FieldView &field, const StokesProblem &problem)
{
  for (int d = 0; d < grid_.dim; ++d)
    for_rows([&](long row, long y, long plane) {
      const long at[3] = {0, grid_.dim == 3 ? y : plane, plane};
      const bool wall_row = d > 0 && on_wall(d, at);
      for (long i = 0; i < grid_.n[0]; ++i)
        if (wall_row || (d == 0 && grid_.walled(0) && i == 0))
          field[d][row + i] = 0.0;
        else
          field[d][row + i] += problem.body_force[static_cast<std::size_t>(d)];
    });
  if (problem.wall_velocity != WallVectors{}) add_moving_walls(field, problem);
  inverse_laplacian(field, 1.0 / problem.viscosity, problem.noisy() ? &problem : nullptr);
}

/// The ghost value behind a wall of velocity V is 2 V - v; the Laplacian has the -v.
void BoxStokes::add_moving_walls(const FieldView &field, const StokesProblem &problem)
{
  for_wall_cells([&](int axis, int side, long place, const long *at) {
    const auto &V = problem.wall_velocity[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
    for (int d = 0; d < grid_.dim; ++d)
      if (d != axis && !on_wall(d, at))
        field[d][place] += 2.0 * problem.viscosity / (grid_.h(axis) * grid_.h(axis)) * V[static_cast<std::size_t>(d)];
  });
}

/// field := D^T cells, on the faces that are not walls.
void BoxStokes::gradient(AlignedVector &cells, const FieldView &field)
{
  const int slow = grid_.slow_axis();
  fetch_plane(comm_, slab(), grid_.n[slow], plane_, cells.data(), Neighbour::before, halo_.data());
  for_rows([&](long row, long y, long plane) {
    const double *c = cells.data() + row;
    const double *before[3] = {c, nullptr, nullptr};
    if (grid_.dim == 3) before[1] = y > 0 ? c - pitch_ : c + (grid_.n[1] - 1) * pitch_;
    before[slow] = plane > slab().start ? c - plane_ : halo_.data() + (grid_.dim == 3 ? y * pitch_ : 0);
    const long at[3] = {0, grid_.dim == 3 ? y : plane, plane};
    double *fx = field[0] + row;
    const double inv_hx = 1.0 / grid_.h(0);
    for (long i = 1; i < grid_.n[0]; ++i) fx[i] = inv_hx * (c[i - 1] - c[i]);
    fx[0] = grid_.walled(0) ? 0.0 : inv_hx * (c[grid_.n[0] - 1] - c[0]);
    for (int d = 1; d < grid_.dim; ++d) {
      double *f = field[d] + row;
      const double inv_h = grid_.walled(d) && at[d] == 0 ? 0.0 : 1.0 / grid_.h(d);
      for (long i = 0; i < grid_.n[0]; ++i) f[i] = inv_h * (before[d][i] - c[i]);
    }
  });
}

/// cells := D field.  Faces on upper walls have no place in the arrays; what is found there, face 0, holds 0.
void BoxStokes::divergence(const FieldView &field, AlignedVector &cells)
{
  const int slow = grid_.slow_axis();
  fetch_plane(comm_, slab(), grid_.n[slow], plane_, field[slow], Neighbour::after, halo_.data());
  for_rows([&](long row, long y, long plane) {
    double *c = cells.data() + row;
    const double *fx = field[0] + row;
    const double inv_hx = 1.0 / grid_.h(0);
    for (long i = 0; i + 1 < grid_.n[0]; ++i) c[i] = inv_hx * (fx[i + 1] - fx[i]);
    c[grid_.n[0] - 1] = inv_hx * (fx[0] - fx[grid_.n[0] - 1]);
    for (int d = 1; d < grid_.dim; ++d) {
      const double *f = field[d] + row, *after;
      if (d == slow)
        after = plane + 1 < slab().start + slab().count ? f + plane_ : halo_.data() + (grid_.dim == 3 ? y * pitch_ : 0);
      else
        after = y + 1 < grid_.n[1] ? f + pitch_ : f - (grid_.n[1] - 1) * pitch_;
      const double inv_h = 1.0 / grid_.h(d);
      for (long i = 0; i < grid_.n[0]; ++i) c[i] += inv_h * (after[i] - f[i]);
    }
  });
}

/// Over the cells of all ranks.  What pads the rows is 0.
double BoxStokes::dot(const AlignedVector &a, const AlignedVector &b) const
{
  return comm_.sum(algebra_.dot(a.data(), b.data(), a.size()));
}

/// Friction and pressure on all walls.  q = pressure_/viscosity of v = u + (-L)^-1 D^T q, with zero mean.
WallVectors BoxStokes::wall_forces(const FieldView &velocity, const StokesProblem &problem) const
{
  WallVectors force{};
  for_wall_cells([&](int axis, int side, long place, const long *at) {
    const double stiffness = problem.viscosity * grid_.cell_volume() / grid_.h(axis);
    auto &f = force[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
    const auto &V = problem.wall_velocity[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
    f[static_cast<std::size_t>(axis)] += (side ? 1.0 : -1.0) * stiffness * pressure_[static_cast<std::size_t>(place)];
    if (grid_.boundary[axis][side] != Boundary::noslip) return;
    for (int d = 0; d < grid_.dim; ++d)
      if (d != axis && !on_wall(d, at))
        f[static_cast<std::size_t>(d)] += 2.0 * stiffness / grid_.h(axis) * (velocity[d][place] - V[static_cast<std::size_t>(d)]);
  });
  return force;
}

SolveReport BoxStokes::solve(const FieldView &field, const StokesProblem &problem)
{
  constexpr int most = 1000;
  const FieldView step = {step_[0].data(), step_[1].data(), step_[2].data()};
  double *const p = pressure_.data(), *const r = residual_.data(), *const d = direction_.data(), *const image = image_.data();
  const long cells = slab().count * plane_;
  SolveReport report;
  unconstrained_velocity(field, problem);
  divergence(field, residual_);
  workers_.for_ranges(cells, [=](long begin, long end) {
    for (long i = begin; i < end; ++i) {
      p[i] = 0.0;
      d[i] = r[i] = -r[i];
    }
  });
  double rr = dot(residual_, residual_);
  const double start = rr;
  // What roundings leave of a divergence is no reason to iterate.
  while (rr > problem.tolerance * problem.tolerance * start && rr > 0.0) {
    if (report.iterations == most) throw NotConverged("the pressure", most, std::sqrt(rr / start), problem.tolerance);
    gradient(direction_, step);
    inverse_laplacian(step, 1.0, nullptr);
    divergence(step, image_);
    const double alpha = rr / dot(direction_, image_);
    workers_.for_ranges(cells, [=](long begin, long end) {
      for (long i = begin; i < end; ++i) {
        p[i] += alpha * d[i];
        r[i] -= alpha * image[i];
      }
      for (int c = 0; c < grid_.dim; ++c)
        for (long i = begin; i < end; ++i) field[c][i] += alpha * step[c][i];
    });
    const double next = dot(residual_, residual_), beta = next / rr;
    workers_.for_ranges(cells, [=](long begin, long end) {
      for (long i = begin; i < end; ++i) d[i] = r[i] + beta * d[i];
    });
    rr = next;
    ++report.iterations;
  }
  report.residual = start > 0.0 ? std::sqrt(rr / start) : 0.0;
  report.wall_force = wall_forces(field, problem);
  return report;
}

}    // namespace bdh
