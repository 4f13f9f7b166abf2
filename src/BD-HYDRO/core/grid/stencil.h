// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The grid lines under a particle, and sums over them: what spreading and interpolation of every
/// kernel share.
#ifndef BDH_GRID_STENCIL_H
#define BDH_GRID_STENCIL_H

#include "grid/columns.h"
#include "grid/sorted_particles.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

namespace bdh {

/// Number of particles whose weights are computed together, in vector registers.  The weights stay
/// in the first-level cache.
constexpr int batch = 16;

/// One number per particle of a batch for each of the W lines under it.
template <class Real, int W> using BatchWeights = Real[W][batch];

/// The grid points under one particle: the weights of W lines per axis, and where the lines begin.
template <class Real, int W> struct Stencil {
  Columns<Real, W> wx;
  const Real *wy, *wz;                    // weights, `batch` numbers apart
  const long *columns, *rows, *planes;    // offsets of the W lines; negative: not in this slab
  long row_columns;                       // columns of a row
  // True if the vector of columns does not run over the end of a row.
  bool whole;
  // Distance of the rows if they follow each other, otherwise 0, as where a box ends: rows beyond a
  // wall may be the same ones again.
  long row_step;
};

/// A part of the columns under a particle whose vector would run over the end of a row: the last
/// vector of the row, or the first one.  It has the lines from begin to end - 1, the first of them
/// in a lane of the vector that begins at `column`.
struct ColumnPart {
  long column;
  int begin, end, lane;

  ColumnPart(int part, long first, long row_columns, int width, int lanes)
  {
    const int last = std::min<long>(width, row_columns - first);
    column = part == 0 ? row_columns - lanes : 0;
    begin = part == 0 ? 0 : last;
    end = part == 0 ? last : width;
    lane = part == 0 ? first - column : 0;
  }
};

/// How many such parts there are; 0 if rows are shorter than the vector, or if columns do not
/// follow each other, as those of walls.
template <class Real, int W> [[gnu::noinline]] int column_parts(const Stencil<Real, W> &s)
{
  const long first = s.columns[0], row = s.row_columns;
  if (row < Columns<Real, W>::lanes || first < 0 || first >= row) return 0;
  for (int i = 1; i < W; ++i)
    if (s.columns[i] != (first + i < row ? first + i : first + i - row)) return 0;
  return first + W > row ? 2 : 1;
}

/// The columns of a particle as vectors: one, or one after the other the parts at both ends of a
/// row.
template <class Real, int W> struct ColumnVector {
  Columns<Real, W> wx;
  long column;
  int parts;    // 0: only one by one

  explicit ColumnVector(const Stencil<Real, W> &s) : wx(s.wx), column(s.columns[0]), parts(1)
  {
    if (!s.whole) parts = column_parts(s);
  }
  /// Goes to a part.
  void take(int part, const Stencil<Real, W> &s)
  {
    if (!s.whole) split(part, s);
  }

 private:
  [[gnu::noinline]] void split(int part, const Stencil<Real, W> &s)
  {
    constexpr int lanes = Columns<Real, W>::lanes;
    const ColumnPart here(part, s.columns[0], s.row_columns, W, lanes);
    Real weight[lanes] = {};
    for (int i = here.begin; i < here.end; ++i) weight[here.lane + i - here.begin] = s.wx[i];
    wx = Columns<Real, W>::at(weight);
    column = here.column;
  }
};

/// The stencil of particle p from its weights `w` along the axes and the first line of each.
/// `faces` is the axis, if any, whose lines are those of its faces.
template <class Real, int W, int D> [[gnu::always_inline]] inline Stencil<Real, W>
make_stencil(int p, const BatchWeights<Real, W> *const (&w)[3], const long (&first)[3],
             const GridLines &lines, int faces = -1)
{
  const auto at = [&](int axis) {
    return lines.at(axis, first[axis], axis == faces ? LineSet::faces : LineSet::centres);
  };
  Stencil<Real, W> s;
  s.wx = Columns<Real, W>{};
  for (int i = 0; i < W; ++i) s.wx.set(i, (*w[0])[i][p]);
  s.wy = (*w[1])[0] + p;
  s.wz = D == 3 ? (*w[2])[0] + p : nullptr;
  s.columns = at(0);
  s.rows = at(1);
  s.planes = at(2);
  s.row_columns = lines.columns();
  s.whole = first[0] >= 0 && first[0] + Columns<Real, W>::lanes <= lines.columns();
  // The second row tells face n of a small walled axis, stored as face 0, from one of them.
  const bool follow =
      s.rows[W - 1] - s.rows[0] == (W - 1) * lines.row() && s.rows[1] - s.rows[0] == lines.row();
  s.row_step = follow ? lines.row() : 0;
  return s;
}

/// Calls action(weight of the row, offset of the row).
template <class Real, int W, int D, class Action>
void for_rows(const Stencil<Real, W> &s, const Action &action)
{
  // The weights and rows are copied because, as far as the compiler knows, the action may write to
  // the stencil.
  Real wy[W];
  long rows[W];
  for (int j = 0; j < W; ++j) {
    wy[j] = s.wy[j * batch];
    rows[j] = s.rows[j];
  }
  for (int k = 0; k < (D == 3 ? W : 1); ++k) {
    const long plane = D == 3 ? s.planes[k] : 0;
    const Real wz = D == 3 ? s.wz[k * batch] : Real(1);
    if (plane < 0) continue;
    for (int j = 0; j < W; ++j)
      if (D == 3 || rows[j] >= 0) action(wz * wy[j], plane + rows[j]);
  }
}

/// The plane under a particle in tiles of several rows, where rows and columns follow each other.
/// One tile takes one operation for all of its rows.
template <class Real, int W> struct PlaneTiles {
  using Row = Columns<Real, W>;
  using Tile = RowTile<Real, Row::lanes>;
  static constexpr int count = (W + Tile::rows - 1) / Tile::rows;
  /// Whether C of them fit into the registers; AVX-512 has twice as many.
  template <int C> static constexpr bool fits = Row::registers == 1 &&
                                                count *C <= (register_bytes == 64 ? 16 : 12);

  typename Tile::Lanes tile[count];

  /// Calls action(tile number, rows from it on) for each tile, both compile-time constants.
  template <class Action> static void for_each(const Action &action)
  {
    for_each(action, std::make_integer_sequence<int, count>());
  }
  /// The weights of columns and rows.
  static PlaneTiles weights(const Row &wx, const Stencil<Real, W> &s)
  {
    PlaneTiles w;
    for_each([&](auto t, auto left) {
      w.tile[t] = Tile::template of<left>(
          [&](int j) { return s.wy[(t * Tile::rows + j) * batch] * wx.part(0); });
    });
    return w;
  }
  /// Tile t of a plane whose rows begin at p.
  template <int t, int left> static typename Tile::Lanes at(const Real *p, long row)
  {
    return Tile::template of<left>(
        [=](int j) { return Row::at(p + (t * Tile::rows + j) * row).part(0); });
  }
  template <int t, int left> static void store(typename Tile::Lanes v, Real *p, long row)
  {
    Tile::template split<left>(v, [=](int j, typename Row::Part columns) {
      std::memcpy(p + (t * Tile::rows + j) * row, &columns, sizeof columns);
    });
  }

 private:
  template <class Action, int... t>
  static void for_each(const Action &action, std::integer_sequence<int, t...>)
  {
    (action(std::integral_constant<int, t>(), std::integral_constant<int, W - t * Tile::rows>()),
     ...);
  }
};

/// Calls action(weight, offset) for the planes under a particle.  They are few, so that nothing is
/// copied as in for_rows().
template <class Real, int W, class Action>
void for_planes(const Stencil<Real, W> &s, long column, const Action &action)
{
  for (int k = 0; k < W; ++k)
    if (s.planes[k] >= 0) action(s.wz[k * batch], s.planes[k] + s.rows[0] + column);
}

/// add() and gather() where rows and columns follow each other.
template <class Real, int W, int C>
[[gnu::flatten]] void add_tiles(const Stencil<Real, W> &s, const ColumnVector<Real, W> &at,
                                const Real (&f)[C], Real *const (&field)[C])
{
  using Tiles = PlaneTiles<Real, W>;
  const Tiles w = Tiles::weights(at.wx, s);
  Tiles line[C];
  for (int c = 0; c < C; ++c)
    for (int t = 0; t < Tiles::count; ++t) line[c].tile[t] = f[c] * w.tile[t];
  for_planes(s, at.column, [&](Real weight, long first) {
    for (int c = 0; c < C; ++c)
      Tiles::for_each([&](auto t, auto left) {
        Real *const p = field[c] + first;
        Tiles::template store<t, left>(
            Tiles::template at<t, left>(p, s.row_step) + weight * line[c].tile[t], p, s.row_step);
      });
  });
}
template <class Real, int W, int C>
[[gnu::flatten]] void gather_tiles(const Stencil<Real, W> &s, const ColumnVector<Real, W> &at,
                                   const Real *const (&field)[C], Real (&total)[C])
{
  using Tiles = PlaneTiles<Real, W>;
  Tiles sum[C] = {};
  for_planes(s, at.column, [&](Real weight, long first) {
    for (int c = 0; c < C; ++c)
      Tiles::for_each([&](auto t, auto left) {
        sum[c].tile[t] += weight * Tiles::template at<t, left>(field[c] + first, s.row_step);
      });
  });
  const Tiles w = Tiles::weights(at.wx, s);
  for (int c = 0; c < C; ++c) {
    auto all = w.tile[0] * sum[c].tile[0];
    for (int t = 1; t < Tiles::count; ++t) all += w.tile[t] * sum[c].tile[t];
    total[c] += sum_of<Real, Tiles::Tile::lanes>(all);
  }
}

/// The registers of the columns that go through the rows together.
template <class Real, int W, int C> using Slice =
    Registers<Real, Columns<Real, W>::in_register, Columns<Real, W>::template at_once<C>>;

/// field_c += f_c * products of the weights, for C fields at once
template <class Real, int W, int D, int C>
void add(const Stencil<Real, W> &s, const Real (&f)[C], Real *const (&field)[C])
{
  using Vector = Columns<Real, W>;
  ColumnVector<Real, W> at(s);
  for (int part = 0; part < at.parts; ++part) {
    at.take(part, s);
    if constexpr (D == 3 && PlaneTiles<Real, W>::template fits<C>)
      if (s.row_step != 0) {
        add_tiles(s, at, f, field);
        continue;
      }
    for (int r = 0; r < Vector::registers; r += Vector::template at_once<C>) {
      Slice<Real, W, C> line[C];
      Real *first[C];
      for (int c = 0; c < C; ++c) {
        line[c] = f[c] * Slice<Real, W, C>::of(at.wx, r);
        first[c] = field[c] + at.column + r * Vector::in_register;
      }
      for_rows<Real, W, D>(s, [line, first](Real weight, long row) {
        for (int c = 0; c < C; ++c) {
          auto p = Slice<Real, W, C>::at(first[c] + row);
          p += weight * line[c];
          p.store(first[c] + row);
        }
      });
    }
  }
  if (at.parts > 0) return;
  for_rows<Real, W, D>(s, [&](Real weight, long row) {
    for (int c = 0; c < C; ++c)
      for (int i = 0; i < W; ++i) field[c][row + s.columns[i]] += weight * (f[c] * s.wx[i]);
  });
}

/// total_c := sum of field_c * products of the weights, for C fields at once
template <class Real, int W, int D, int C>
void gather(const Stencil<Real, W> &s, const Real *const (&field)[C], Real (&total)[C])
{
  for (Real &t : total) t = 0;
  using Vector = Columns<Real, W>;
  ColumnVector<Real, W> at(s);
  for (int part = 0; part < at.parts; ++part) {
    at.take(part, s);
    if constexpr (D == 3 && PlaneTiles<Real, W>::template fits<C>)
      if (s.row_step != 0) {
        gather_tiles(s, at, field, total);
        continue;
      }
    for (int r = 0; r < Vector::registers; r += Vector::template at_once<C>) {
      Slice<Real, W, C> sum[C] = {};
      const Real *first[C];
      for (int c = 0; c < C; ++c) first[c] = field[c] + at.column + r * Vector::in_register;
      for_rows<Real, W, D>(s, [&sum, first](Real weight, long row) {
        for (int c = 0; c < C; ++c) sum[c] += weight * Slice<Real, W, C>::at(first[c] + row);
      });
      for (int c = 0; c < C; ++c) total[c] += dot(Slice<Real, W, C>::of(at.wx, r), sum[c]);
    }
  }
  if (at.parts > 0) return;
  for_rows<Real, W, D>(s, [&](Real weight, long row) {
    for (int c = 0; c < C; ++c)
      for (int i = 0; i < W; ++i) total[c] += weight * (s.wx[i] * field[c][row + s.columns[i]]);
  });
}

/// Calls action(first particle, how many) for batches of a range in sorted order, with the field's
/// C components read ahead of them.
template <class Real, std::size_t C, class Action>
void for_range(const GridParticles &particles, const std::array<long, 2> &range,
               const std::array<Real *, C> &field, Action action)
{
  static_assert(batch <= GridParticles::read_whole, "batches are read whole");
  const int components = C == 3 ? particles.grid().dim : C;
  GridParticles::ReadAhead<Real> grid(particles, field.data(), components);
  for (long begin = range[0]; begin < range[1]; begin += batch) {
    const int count = std::min<long>(batch, range[1] - begin);
    grid.until(begin + count - 1);
    action(begin, count);
  }
}

/// Does the action write to the field, so that particles of neighbouring layers may not be handled
/// at the same time?
enum class FieldAccess { reads, writes };

/// The same for all particles, shared among the workers.  It calls action(work, first particle, how
/// many), with a Work for each task.
template <class Work, class Real, std::size_t C, class Action>
void for_batches(const GridParticles &particles, const std::array<Real *, C> &field,
                 FieldAccess access, Action action)
{
  const Workers &workers = particles.workers();
  if (workers.alone() || particles.layers() == 1) {
    Work work;
    return for_range(particles, {0, particles.size()}, field,
                     [&](long begin, int count) { action(work, begin, count); });
  }
  const auto layer = [&](long l) {
    Work work;
    for (long tile = 0; tile < particles.tiles(); ++tile)
      for_range(particles, particles.range(l, tile), field,
                [&](long begin, int count) { action(work, begin, count); });
  };
  if (access == FieldAccess::reads)
    return workers.run(particles.layers(), [&](long l, int) { layer(l); });
  for (long odd : {0, 1})
    workers.run(particles.layers() / 2, [&](long l, int) { layer(2 * l + odd); });
}

}    // namespace bdh
#endif
