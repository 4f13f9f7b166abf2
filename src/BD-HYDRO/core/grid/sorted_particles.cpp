// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/sorted_particles.h"

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/portable.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bdh {

namespace {

// Cells per particle above which reading all rows costs more than it saves, measured at 128^3.  At
// 32 cells per particle it halves the time.
constexpr long sparse = 200;

// Bytes of a field below which caches deliver its rows fast enough in any order: reading ahead
// saves a quarter of the time of 50 MB, nothing of 25, and costs a fifth of 6 (Sapphire Rapids).
constexpr long cached_bytes = 1L << 24;

// Bytes for the planes that a tile of rows has in use, half of a second-level cache of 1 MiB.
constexpr long tile_bytes = 1 << 19;

}    // namespace

namespace {

[[noreturn]] void report_outside(const Grid &grid, long i, int d, bool upper, double x)
{
  std::ostringstream text;
  const bool open = grid.boundary[d][upper] == Boundary::open;
  text << (open ? "it has left through the open face " : "it is outside the wall ") << "xyz"[d]
       << (upper ? "hi" : "lo") << " ("
       << "xyz"[d] << " = " << x << ", the " << (open ? "face" : "wall") << " is at "
       << (upper ? grid.box_hi(d) : grid.box_lo(d)) << "): ";
  if (open)
    text << "make the box larger on that side, which changes nothing else above a no-slip wall, or "
            "hold the particles back by a force (fix wall/harmonic)";
  else
    text << "use a smaller timestep, or a force that keeps particles off the wall (fix "
            "wall/harmonic), or the keyword "
            "crossing";
  throw BadParticle(i, text.str());
}

/// Sign of the images of centre lines beyond a face; 0: none.
double image_sign(Boundary kind)
{
  switch (kind) {
  case Boundary::noslip: return -1.0;
  case Boundary::slip:
  case Boundary::periodic: return 1.0;
  case Boundary::open: break;
  }
  return 0.0;
}

}    // namespace

AxisLines axis_lines(const Grid &grid, int axis)
{
  const auto &kinds = grid.boundary[axis];
  return {grid.n[axis],      grid.lo[axis],        grid.h(axis),
          grid.walled(axis), image_sign(kinds[0]), image_sign(kinds[1])};
}

WallLimits box_limits(const Grid &grid, double slack)
{
  // The rows beyond an open face leave half a spacing.  The least is for roundings of the face.
  const auto more = [&](int d, int side) {
    const bool open = grid.boundary[d][side] == Boundary::open;
    return (open ? std::clamp(slack, 1e-9, 0.5) : slack) * grid.h(d);
  };
  WallLimits w{};
  w.dim = grid.dim;
  for (int d = 0; d < grid.dim; ++d) {
    w.walled[d] = grid.walled(d);
    w.lo[d] = grid.box_lo(d) - more(d, 0);
    w.hi[d] = grid.box_hi(d) + more(d, 1);
  }
  return w;
}

WallLimits fit_limits(const Grid &grid)
{
  WallLimits w = box_limits(grid);
  for (int d = 0; d < grid.dim; ++d) {
    w.lo[d] = grid.left_out[d][0] != 0.0 ? grid.fit_lo(d) : -HUGE_VAL;
    w.hi[d] = grid.left_out[d][1] != 0.0 ? grid.fit_hi(d) : HUGE_VAL;
  }
  return w;
}

WallLimits wall_limits(const Grid &grid)
{
  WallLimits w = box_limits(grid);
  for (int d = 0; d < grid.dim; ++d) {
    if (grid.boundary[d][0] == Boundary::open) w.lo[d] = -HUGE_VAL;
    if (grid.boundary[d][1] == Boundary::open) w.hi[d] = HUGE_VAL;
  }
  return w;
}

HasNoCell positions_without_cell(const Grid &grid, const double *x, double slack)
{
  HasNoCell c{box_limits(grid, slack), {}, {}, x};
  for (int d = 0; d < grid.dim; ++d) {
    c.lo[d] = grid.lo[d];
    c.far[d] = 1e12 * grid.length[d];
  }
  return c;
}

void check_positions(const Grid &grid, const double *x, long n, double slack)
{
  const HasNoCell bad = positions_without_cell(grid, x, slack);
  for (long i = 0; i < n; ++i) {
    if (!bad(i)) continue;
    for (int d = 0; d < grid.dim; ++d) {
      const double q = x[3 * i + d];
      if (!(std::fabs(q - bad.lo[d]) < bad.far[d]))
        throw BadParticle(i, "its position is not a finite number, or astronomically far away: use "
                             "a smaller timestep");
      if (grid.walled(d) && (q < bad.walls.lo[d] || q > bad.walls.hi[d]))
        report_outside(grid, i, d, q > bad.walls.hi[d], q);
    }
  }
}

GridLines::GridLines(const Grid &grid, const Slab &slab) :
    columns_(grid.n[0]), row_(2 * grid.half()), plane_(grid.dim == 3 ? row_ * grid.n[1] : row_)
{
  const long spacing[3] = {1, row_, plane_};
  for (LineSet set : {LineSet::centres, LineSet::faces})
    for (int d = 0; d < 3; ++d) {
      std::vector<long> &offset = offset_[static_cast<int>(set)][d];
      for (long i = -margin; i <= grid.n[d] + margin; ++i) {
        const long line = stored_line(axis_lines(grid, d), set == LineSet::faces, i);
        if (d != grid.slow_axis())
          offset.push_back(line * spacing[d]);
        else
          offset.push_back(slab.contains(line) ? (line - slab.start) * spacing[d] : -1);
      }
    }
}

GridParticles::GridParticles(const Grid &grid, const Slab &slab, int width, int element_bytes,
                             const Workers &workers) :
    workers_(workers),
    grid_(grid), slab_(slab), width_(width), lines_(grid, slab)
{
  const long row_bytes = element_bytes * grid.dim * (width_ + 1) * lines_.row();
  tile_rows_ =
      std::clamp(tile_bytes / row_bytes - width_, 1L * width_, std::max(1L * width_, grid.n[1]));
  if (grid.dim == 2) tile_rows_ = 1;    // a plane is a row
  tiles_ = grid.dim == 3 ? (grid.n[1] + tile_rows_ - 1) / tile_rows_ : 1;
  const long most = grid.n[grid.slow_axis()] / width_;
  layers_ = std::max(1L, most >= 4 ? most / 4 * 4 : most / 2 * 2);
}

std::array<long, 2> GridParticles::range(long layer, long tile) const
{
  const long planes = grid_.n[grid_.slow_axis()];
  // After bind(), bin_ holds ends.
  const auto before = [&](long plane) {
    const long key = (tile * planes + plane) * tile_rows_;
    return key ? bin_[key - 1] : 0L;
  };
  return {before(layer * planes / layers_), before((layer + 1) * planes / layers_)};
}

void GridParticles::scale(const double *x, long n)
{
  for (int d = 0; d < grid_.dim; ++d) {
    scaled_[d].resize(n);
    double *to = scaled_[d].data();
    const AxisLines axis = axis_lines(grid_, d);
    workers_.for_ranges(n, [=](long begin, long end) {
      BDH_INDEPENDENT
      for (long i = begin; i < end; ++i) to[i] = cells_from_end(axis, x[3 * i + d]);
    });
  }
}

/// key_ := place of each particle's grid row in the order tile, plane, row.
/// bin_[k + 1] := number of particles with key k.
void GridParticles::count_keys(long n)
{
  const bool planes = grid_.dim == 3;
  std::vector<int> row_key;
  for (long y = 0; y < grid_.n[1]; ++y)
    row_key.push_back(y / tile_rows_ * tile_rows_ * grid_.n[2] + y % tile_rows_);
  // A finite difference may step a little over a wall.
  const auto cell = [this](int d, long i) {
    return std::clamp(static_cast<long>(scaled_[d][i]), 0L, grid_.n[d] - 1);
  };
  key_.resize(n);
  workers_.for_ranges(n, [&](long begin, long end) {
    for (long i = begin; i < end; ++i) {
      key_[i] = row_key[cell(1, i)];
      if (planes) key_[i] += tile_rows_ * cell(2, i);
    }
  });
  bin_.assign((tiles_ * tile_rows_ * grid_.n[grid_.slow_axis()]) + 1, 0);
  for (long i = 0; i < n; ++i) ++bin_[key_[i] + 1];
}

void GridParticles::bind(const double *x, long n)
{
  // This is a counting sort.
  scale(x, n);
  count_keys(n);
  for (std::size_t k = 1; k < bin_.size(); ++k) bin_[k] += bin_[k - 1];
  for (int d = 0; d < 3; ++d) x_[d].assign(n + read_whole, 0.0);
  original_.resize(n);
  for (long i = 0; i < n; ++i) {
    const int place = bin_[key_[i]]++;
    original_[place] = i;
    for (int d = 0; d < grid_.dim; ++d) x_[d][place] = scaled_[d][i];
  }
}

std::size_t GridParticles::memory() const { return bytes_of(original_, key_, bin_, x_, scaled_); }

template <class Real>
GridParticles::ReadAhead<Real>::ReadAhead(const GridParticles &particles, Real *const *component,
                                          int components) :
    particles_(particles),
    component_(component), components_(components)
{
  const long field = particles.slab_.count * particles.lines_.plane();
  worthwhile_ = particles.size() * sparse > field &&
                field * components * static_cast<long>(sizeof(Real)) > cached_bytes;
}

template <class Real> void GridParticles::ReadAhead<Real>::until(long p)
{
  if (!worthwhile_) return;
  const Grid &g = particles_.grid_;
  const GridLines &lines = particles_.lines_;
  const long width = particles_.width_, rows = particles_.tile_rows_;
  const long plane = static_cast<long>(particles_.x_[g.slow_axis()][p]) - particles_.slab_.start;
  const long new_tile = g.dim == 3 ? static_cast<long>(particles_.x_[1][p]) / rows : 0;
  if (new_tile != tile_) next_plane_ = plane - width;
  tile_ = new_tile;
  const long first_row = std::max(0L, tile_ * rows - width);
  const long last_row = g.dim == 3 ? std::min(g.n[1], (tile_ + 1) * rows + width) : 1;
  const long end = std::min(plane + width, particles_.slab_.count);
  for (next_plane_ = std::max(0L, next_plane_); next_plane_ < end; ++next_plane_)
    read(next_plane_ * lines.plane(), first_row * lines.row(), last_row * lines.row());
}

template <class Real>
void GridParticles::ReadAhead<Real>::read(long plane, long begin, long end) const
{
  constexpr long cache_line = 64 / sizeof(Real);
  for (int d = 0; d < components_; ++d)
    for (long i = begin; i < end; i += cache_line) {
      const volatile Real *p = component_[d] + plane + i;
      // A read would be a race if another worker writes there; a prefetch is not.
      if (particles_.workers_.alone())
        (void) *p;
      else
        __builtin_prefetch(const_cast<const Real *>(p));
    }
}

template class GridParticles::ReadAhead<float>;
template class GridParticles::ReadAhead<double>;

}    // namespace bdh
