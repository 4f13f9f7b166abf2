// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/trig.h"

#include "base/constants.h"
#include "grid/fftw.h"
#include "grid/transposition.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

using Plan = FftwPlan<double>;
using PlanPair = FftwPlanPair<double>;

/// One axis of one component.
struct AxisKind {
  long n, first;    // unknowns, and the index of the first of them
  fftw_r2r_kind forward, backward;
  AxisModes modes;
};

/// Between walls the eigenvalues are (2 sin(pi (j + shift)/(2 n))/h)^2.  Of the basis vectors that
/// the backward transform adds up, those that are +-1 everywhere have half the squared norm of the
/// others.  (For Fourier modes, those have n, and the others 2 n.)
AxisKind axis_kind(const Grid &g, int component, int axis)
{
  const long n = g.n[axis];
  const double h = g.h(axis);
  const bool own = component == axis, lower = is_noslip_wall(g.boundary[axis][0]),
             upper = is_noslip_wall(g.boundary[axis][1]);
  AxisKind k{n, 0, FFTW_R2HC, FFTW_HC2R, {}};
  double shift = 0.0;
  long alone = -1;    // index of the vector that is +-1
  if (g.walled(axis)) {
    if (own) {
      k = {n - 1, 1, FFTW_RODFT00, FFTW_RODFT00, {}};
    } else if (lower && upper) {
      k = {n, 0, FFTW_RODFT10, FFTW_RODFT01, {}};
      shift = 1.0;
      alone = n - 1;
    } else if (!lower && !upper) {
      k = {n, 0, FFTW_REDFT10, FFTW_REDFT01, {}};
      alone = 0;
    } else {
      k = {n, 0, lower ? FFTW_RODFT11 : FFTW_REDFT11, lower ? FFTW_RODFT11 : FFTW_REDFT11, {}};
      shift = 0.5;
    }
  }
  for (long j = 0; j < n; ++j) {
    const double angle = g.walled(axis) ? pi * (j + shift) / (2 * n) : pi * j / n;
    const double s = 2.0 * std::sin(angle) / h;
    k.modes.eigenvalue.push_back(s * s);
    if (g.walled(axis))
      k.modes.weight.push_back(j < k.first ? 0.0 : j == alone ? 0.5 : 1.0);
    else
      k.modes.weight.push_back(j == 0 || 2 * j == n ? 1.0 : 2.0);
  }
  return k;
}

/// Column by column, the matrix has the transforms of the unit vectors.
std::vector<double> matrix_of(const AxisKind &k, fftw_r2r_kind direction)
{
  const long n = k.first + k.n;
  std::vector<double> matrix(n * n, 0.0);
  const auto column = [&](long j) { return matrix.data() + j * n + k.first; };
  const Plan plan(
      fftw_plan_r2r_1d(k.n, column(0), column(0), direction, FFTW_ESTIMATE | FFTW_UNALIGNED));
  for (long j = k.first; j < n; ++j) {
    column(j)[j - k.first] = 1.0;
    fftw_execute_r2r(plan.get(), column(j), column(j));
  }
  return matrix;
}

// A grid that is large enough gets at least so many blocks.
constexpr long least_blocks = 16;
// Cost of transforming a number, relative to that of adding one.
constexpr long transform_cost = 8;

long plane_size(const Grid &g) { return 2 * g.half() * (g.dim == 3 ? g.n[1] : 1); }

PartsOfRanks equal_parts(long size, int ranks)
{
  PartsOfRanks parts;
  for (int r = 0; r < ranks; ++r) {
    const Slab part = equal_part(size, r, ranks);
    parts.push_back({{part.start, part.count}});
  }
  return parts;
}

}    // namespace

AxisModes axis_modes(const Grid &grid, int component, int axis)
{
  return axis_kind(grid, component, axis).modes;
}

AxisMatrices axis_matrices(const Grid &grid, int component, int axis)
{
  const AxisKind k = axis_kind(grid, component, axis);
  return {matrix_of(k, k.forward), matrix_of(k, k.backward)};
}

double transform_norm(const Grid &grid)
{
  double product = 1.0;
  for (int d = 0; d < grid.dim; ++d) product *= (grid.walled(d) ? 2 : 1) * grid.n[d];
  return product;
}

struct WalledTransforms::Impl {
  Impl(const Grid &g, const Comm &c, FftEffort effort, const Workers &w);

  PlanPair plan_plane(int component, double *scratch, unsigned flags) const;
  PlanPair plan_slow(int component, long columns, double *scratch, unsigned flags) const;
  long plane_offset(long component) const
  {
    return kind[component][0].first + pitch * (grid.dim == 3 ? kind[component][1].first : 0);
  }
  void transform_planes(const std::array<double *, 3> &field, Plan PlanPair::*direction) const;
  void one_block(const std::array<double *, 3> &field, const Slab &block,
                 const Change &change) const;

  Grid grid;
  GridParts parts;
  const Workers &workers;
  int slow;
  long pitch;    // doubles from row to row
  Slab mine;     // places of a plane that this rank has after the hand-over
  Transposition<double> transposition;
  std::size_t allocation;
  std::vector<std::vector<AxisKind>> kind;    // [component][axis]
  long width;                                 // columns of a block, except the last one
  // For each component: plans of a plane, along the slow axis of a block, and of the last block.
  std::vector<PlanPair> planes, full, rest;
};

WalledTransforms::Impl::Impl(const Grid &g, const Comm &c, FftEffort effort, const Workers &w) :
    grid(g), parts(g, c, 1), workers(w), slow(g.slow_axis()), pitch(2 * g.half()),
    mine(equal_part(plane_size(g), c.rank(), c.size())),
    transposition(c, c.size(), g.n[slow], plane_size(g), equal_parts(plane_size(g), c.size())),
    allocation(std::max(1L, std::max(transposition.slab().count * transposition.plane_size(),
                                     g.n[slow] * mine.count)))
{
  // Blocks of small grids are narrow, so that each worker gets some.  They are whole cache lines.
  width = std::min(widest, (mine.count / least_blocks + 7) / 8 * 8);
  width = std::max(1L, std::min(std::max(8L, width), mine.count));
  AlignedVector scratch(std::max<std::size_t>(allocation, transposition.plane_size()));
  // Arrays start at any face, so they are unaligned.
  const unsigned flags =
      FFTW_UNALIGNED | (effort == FftEffort::estimate ? FFTW_ESTIMATE : FFTW_MEASURE);
  for (int d = 0; d < g.dim; ++d) {
    kind.emplace_back();
    for (int axis = 0; axis < g.dim; ++axis) kind.back().push_back(axis_kind(g, d, axis));
    planes.push_back(plan_plane(d, scratch.data(), flags));
    full.push_back(plan_slow(d, std::min(width, mine.count), scratch.data(), flags));
    rest.push_back(plan_slow(d, mine.count % width, scratch.data(), flags));
  }
}

PlanPair WalledTransforms::Impl::plan_plane(int component, double *scratch, unsigned flags) const
{
  const int rank = grid.dim - 1;
  int n[2], embed[2];
  fftw_r2r_kind forward[2], backward[2];
  for (int i = 0; i < rank; ++i) {
    const AxisKind &k = kind[component][rank - 1 - i];
    n[i] = k.n;
    forward[i] = k.forward;
    backward[i] = k.backward;
    embed[i] = i == rank - 1 ? pitch : grid.n[1];
  }
  double *at = scratch + plane_offset(component);
  PlanPair p;
  p.forward.reset(fftw_plan_many_r2r(rank, n, 1, at, embed, 1, 0, at, embed, 1, 0, forward, flags));
  p.backward.reset(
      fftw_plan_many_r2r(rank, n, 1, at, embed, 1, 0, at, embed, 1, 0, backward, flags));
  return p;
}

PlanPair WalledTransforms::Impl::plan_slow(int component, long columns, double *scratch,
                                           unsigned flags) const
{
  PlanPair p;
  if (columns == 0) return p;
  const AxisKind &k = kind[component][slow];
  const int n = k.n, many = columns, stride = mine.count;
  double *at = scratch + k.first * mine.count;
  p.forward.reset(fftw_plan_many_r2r(1, &n, many, at, nullptr, stride, 1, at, nullptr, stride, 1,
                                     &k.forward, flags));
  p.backward.reset(fftw_plan_many_r2r(1, &n, many, at, nullptr, stride, 1, at, nullptr, stride, 1,
                                      &k.backward, flags));
  return p;
}

void WalledTransforms::Impl::transform_planes(const std::array<double *, 3> &field,
                                              Plan PlanPair::*direction) const
{
  const long count = transposition.slab().count, plane = transposition.plane_size();
  workers.for_ranges(
      grid.dim * count,
      [&](long begin, long end) {
        for (long i = begin; i < end; ++i) {
          const long d = i / count;
          double *at = field[d] + i % count * plane + plane_offset(d);
          fftw_execute_r2r((planes[d].*direction).get(), at, at);
        }
      },
      transform_cost * plane);
}

/// The three components of a block stay in the second-level cache between the transforms.
void WalledTransforms::Impl::one_block(const std::array<double *, 3> &field, const Slab &block,
                                       const Change &change) const
{
  const std::vector<PlanPair> &plans = block.count == width ? full : rest;
  const auto transform = [&](Plan PlanPair::*direction) {
    for (int d = 0; d < grid.dim; ++d) {
      double *at = field[d] + kind[d][slow].first * mine.count + block.start;
      fftw_execute_r2r((plans[d].*direction).get(), at, at);
    }
  };
  transform(&PlanPair::forward);
  change(block);
  transform(&PlanPair::backward);
}

WalledTransforms::WalledTransforms(const Grid &grid, const Comm &comm, FftEffort effort,
                                   const Workers &workers) :
    impl_(std::make_unique<Impl>(grid, comm, effort, workers))
{}

WalledTransforms::~WalledTransforms() = default;

const GridParts &WalledTransforms::parts() const { return impl_->parts; }
std::size_t WalledTransforms::allocation() const { return impl_->allocation; }
Slab WalledTransforms::columns() const { return impl_->mine; }

const AxisModes &WalledTransforms::modes(int component, int axis) const
{
  return impl_->kind[component][axis].modes;
}

void WalledTransforms::solve(const std::array<double *, 3> &field, const Change &change)
{
  Impl &m = *impl_;
  m.transform_planes(field, &PlanPair::forward);
  for (int d = 0; d < m.grid.dim; ++d) m.transposition.hand_over(field[d]);
  m.workers.run((m.mine.count + m.width - 1) / m.width, [&](long i, int) {
    m.one_block(field, {i * m.width, std::min(m.width, m.mine.count - i * m.width)}, change);
  });
  for (int d = 0; d < m.grid.dim; ++d) m.transposition.hand_back(field[d]);
  m.transform_planes(field, &PlanPair::backward);
}

std::size_t WalledTransforms::memory() const { return impl_->transposition.memory(); }

}    // namespace bdh
