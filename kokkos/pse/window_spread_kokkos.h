// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation of the non-uniform Fourier transform on a device: S and S^T of PSE
/// sec. II B 2.
///
/// There are two ways to spread.  By particle: one thread handles each plane of lines under a
/// particle, with atomic additions to the grid.  By tile: particles are sorted into tiles of 8^3
/// cells; a team adds up those of a tile in fast memory and then adds the tile with its rim, (8 +
/// W)^3 numbers, to the grid.  The second way needs fewer atomic operations on the grid if
///
///     N W^3 > tiles (8 + W)^3,
///
/// that is, with more than 13 particles per tile for W = 6, or 6 for W = 10.  `automatic` follows
/// this rule if the tile fits into fast memory.
#ifndef BDH_PSE_WINDOW_SPREAD_KOKKOS_H
#define BDH_PSE_WINDOW_SPREAD_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "grid/grid.h"
#include "grid/lines_kernel.h"
#include "pse/layout.h"
#include "pse/window.h"
#include "pse/window_choice.h"
#include "pse/window_kernel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace bdh {

enum class SpreadBy { automatic, particles, tiles };

static_assert(dof == dim, "one component of the field carries one number of each particle");

/// A field of dim components on the corners of this rank's planes of a periodic grid, and the
/// window.
template <class Real> struct DeviceWindow {
  long n[dim];           ///< of the whole grid
  long first, planes;    ///< of this rank
  long row, plane;       ///< elements from row to row, from plane to plane
  Real *component[dim];
  const Real *coefficient;    ///< in the memory of the device
  int degree;

  /// The place of plane `line` in the arrays; -1 if another rank has it.
  BDH_FN long place_of_plane(long line) const
  {
    const long mine = wrap_line(line, n[2]) - first;
    return mine >= 0 && mine < planes ? mine * plane : -1;
  }
};

/// Weights and lines of a particle along one axis; W lines.
template <class Real, int W> struct WindowLines {
  Real w[W];
  long first;
  BDH_FN WindowLines(const DeviceWindow<Real> &g, double x)
  {
    double t;
    first = first_window_line(x, W, t);
    for (int i = 0; i < W; ++i) w[i] = window_weight(g.coefficient, W, g.degree, i, Real(t));
  }
};

/// Weight and index of line k of a particle along one axis.
template <class Real, int W> struct WindowLine {
  Real w;
  long line;
  BDH_FN WindowLine(const DeviceWindow<Real> &g, double x, int k)
  {
    double t;
    line = first_window_line(x, W, t) + k;
    w = window_weight(g.coefficient, W, g.degree, k, Real(t));
  }
};

/// The position of a particle, in spacings, wrapped into the box.  The index is (particle, axis).
struct ScaleFractions {
  AxisLines axis[dim];
  const double *from;
  double *to;
  BDH_FN void operator()(long index) const
  {
    to[index] = cells_from_end(axis[index % dim], from[index]);
  }
};

/// field += S F.  The index is (particle, plane under it), the last one fastest.
template <class Real, int W> struct SpreadPlane {
  DeviceWindow<Real> grid;
  const double *x, *force;
  BDH_FN void operator()(long index) const
  {
    const long p = index / W;
    const int k = index % W;
    const WindowLines<Real, W> wx(grid, x[dim * p]), wy(grid, x[dim * p + 1]);
    const WindowLine<Real, W> wz(grid, x[dim * p + 2], k);
    const long plane = grid.place_of_plane(wz.line);
    if (plane < 0) return;
    long column[W];
    for (int i = 0; i < W; ++i) column[i] = wrap_line(wx.first + i, grid.n[0]);
    for (int j = 0; j < W; ++j) {
      const long row = plane + wrap_line(wy.first + j, grid.n[1]) * grid.row;
      const Real weight = wz.w * wy.w[j];
      for (int c = 0; c < dof; ++c) {
        const Real f = weight * Real(force[dof * p + c]);
        for (int i = 0; i < W; ++i)
          Kokkos::atomic_add(grid.component[c] + row + column[i], f * wx.w[i]);
      }
    }
  }
};

/// velocity := S^T field.  The index is (particle, component), the last one fastest.
template <class Real, int W> struct GatherWindow {
  DeviceWindow<Real> grid;
  const double *x;
  double *velocity;
  BDH_FN void operator()(long index) const
  {
    const long p = index / dof;
    const Real *from = grid.component[index % dof];
    const WindowLines<Real, W> wx(grid, x[dim * p]), wy(grid, x[dim * p + 1]),
        wz(grid, x[dim * p + 2]);
    long column[W];
    for (int i = 0; i < W; ++i) column[i] = wrap_line(wx.first + i, grid.n[0]);
    Real sum = 0;
    for (int k = 0; k < W; ++k) {
      const long plane = grid.place_of_plane(wz.first + k);
      if (plane < 0) continue;
      for (int j = 0; j < W; ++j) {
        const Real *row = from + plane + wrap_line(wy.first + j, grid.n[1]) * grid.row;
        Real of_row = 0;
        for (int i = 0; i < W; ++i) of_row += wx.w[i] * row[column[i]];
        sum += wz.w[k] * wy.w[j] * of_row;
      }
    }
    velocity[index] = sum;
  }
};

/// Tiles of `side`^3 cells; those at the upper end of an axis may be smaller.
struct Tiles {
  static constexpr int side = 8;
  long n[dim];    ///< tiles per axis
  long count() const { return n[0] * n[1] * n[2]; }
  BDH_FN long of(const double *x) const
  {
    return (along_axis(x[2]) * n[1] + along_axis(x[1])) * n[0] + along_axis(x[0]);
  }
  BDH_FN static long along_axis(double x)
  {
    const long cell = x;
    return cell / side;
  }
};

/// members[tile] := number of particles in it.
struct CountInTiles {
  Tiles tiles;
  const double *x;
  int *members;
  BDH_FN void operator()(long p) const { Kokkos::atomic_add(members + tiles.of(x + dim * p), 1); }
};
/// begin[tile] := number of particles in all tiles before it; begin has one more entry than there
/// are tiles.
struct SumTiles {
  const int *members;
  int *begin, *next;
  long tiles;
  BDH_FN void operator()(long t, int &sum, bool last) const
  {
    if (last) begin[t] = next[t] = sum;
    sum += members[t];
    if (last && t == tiles - 1) begin[tiles] = sum;
  }
};
/// order := the particles tile by tile, in any order within each tile.
struct SortIntoTiles {
  Tiles tiles;
  const double *x;
  int *next, *order;
  BDH_FN void operator()(long p) const
  {
    order[Kokkos::atomic_fetch_add(next + tiles.of(x + dim * p), 1)] = p;
  }
};

/// field += S F for the particles of one tile and one component; the work of one team.
template <class Real, int W, class Exec> struct SpreadTile {
  using Team = typename Kokkos::TeamPolicy<Exec>::member_type;
  using Scratch = Kokkos::View<Real *, typename Exec::scratch_memory_space,
                               Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  static constexpr int side = Tiles::side + W, cells = side * side * side;    // including the rim

  DeviceWindow<Real> grid;
  Tiles tiles;
  const double *x, *force;
  const int *begin, *order;

  /// Adds one plane of one particle to the tile.  origin: the line of the tile's first cell along
  /// each axis.
  BDH_FN void add_plane(Real *tile, const long *origin, long p, int k, int c) const
  {
    const WindowLines<Real, W> wx(grid, x[dim * p]), wy(grid, x[dim * p + 1]);
    const WindowLine<Real, W> wz(grid, x[dim * p + 2], k);
    const Real f = wz.w * Real(force[dof * p + c]);
    Real *corner = tile + ((wz.line - origin[2]) * side + (wy.first - origin[1])) * side +
                   (wx.first - origin[0]);
    for (int j = 0; j < W; ++j)
      for (int i = 0; i < W; ++i) Kokkos::atomic_add(corner + j * side + i, f * wy.w[j] * wx.w[i]);
  }
  /// Adds one cell of the tile to the grid.
  BDH_FN void hand_in(const Real *tile, const long *origin, int cell, int c) const
  {
    if (tile[cell] == Real(0)) return;
    const long i = wrap_line(origin[0] + cell % side, grid.n[0]),
               j = wrap_line(origin[1] + cell / side % side, grid.n[1]),
               plane = grid.place_of_plane(origin[2] + cell / (side * side));
    if (plane >= 0) Kokkos::atomic_add(grid.component[c] + plane + j * grid.row + i, tile[cell]);
  }

  /// The team index is (tile, component), the last one fastest.
  BDH_FN void operator()(const Team &team) const
  {
    const long t = team.league_rank() / dof;
    const int c = team.league_rank() % dof, first = begin[t], members = begin[t + 1] - first;
    if (members == 0) return;
    const long index[dim] = {t % tiles.n[0], t / tiles.n[0] % tiles.n[1],
                             t / (tiles.n[0] * tiles.n[1])};
    long origin[dim];
    // first_window_line() returns no lower line.
    for (int d = 0; d < dim; ++d) origin[d] = index[d] * Tiles::side - W / 2;
    Scratch tile(team.team_scratch(0), cells);
    Real *const numbers = tile.data();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, cells),
                         [=](int cell) { numbers[cell] = Real(0); });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, members * W), [&](int m) {
      add_plane(numbers, origin, order[first + m / W], m % W, c);
    });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, cells),
                         [&](int cell) { hand_in(numbers, origin, cell, c); });
  }
};

/// The lowest line of axis d that each particle touches.
struct FirstWindowLine {
  AxisLines axis;
  int d;
  const double *s;    ///< fractional coordinates, dim per particle
  int width;
  BDH_FN long operator()(long p) const
  {
    double t;
    return first_window_line(cells_from_end(axis, s[dim * p + d]), width, t);
  }
};

/// The counterpart of WindowSpreader.  Pointers are device pointers.
template <class Real, class Exec> class DeviceWindowSpreader {
 public:
  using View = std::array<Real *, dim>;    ///< rows padded to 2 (n_x/2 + 1)

  DeviceWindowSpreader(const std::array<long, dim> &n, const Slab &slab, const Window &window,
                       double error, SpreadBy by = SpreadBy::automatic) :
      n_(n),
      slab_(slab), by_(by)
  {
    const WindowPolynomials polynomials(window, error);
    const std::vector<double> &c = polynomials.coefficients();
    coefficient_.assign(std::vector<Real>(c.begin(), c.end()).data(), c.size());
    width_ = polynomials.width();
    degree_ = polynomials.degree();
    for (int d = 0; d < dim; ++d) tiles_.n[d] = (n[d] + Tiles::side - 1) / Tiles::side;
  }

  FirstLines<FirstWindowLine, FirstWindowLine> first_lines(const double *s) const
  {
    return {{axis(2), 2, s, width_}, {axis(1), 1, s, width_}};
  }
  long reach() const { return width_; }

  /// s: fractional coordinates of n particles, dim numbers each; any periodic image, but finite.
  /// They are copied.
  void bind(const double *s, long n)
  {
    particles_ = n;
    x_.resize(dim * n);
    ScaleFractions scale{{}, s, x_.data()};
    for (int d = 0; d < dim; ++d) scale.axis[d] = axis(d);
    device_for<Exec>("bdh::bind_window", dim * n, scale);
    sorted_ = false;
  }

  /// field += S F
  void spread(const double *force, const View &field)
  {
    dispatch([&](auto width) { spread_width<decltype(width)::value>(force, field); });
  }
  /// velocity := S^T field
  void interpolate(const View &field, double *velocity) const
  {
    dispatch([&](auto width) {
      device_for<Exec>(
          "bdh::interpolate_window", dof * particles_,
          GatherWindow<Real, decltype(width)::value>{window(field), x_.data(), velocity});
    });
  }

  std::size_t memory() const { return bytes_of(x_, begin_, next_, order_, members_); }

 protected:
  DeviceWindow<Real> window(const View &field) const
  {
    const long row = 2 * (n_[0] / 2 + 1);
    return {{n_[0], n_[1], n_[2]},          slab_.start,         slab_.count, row, row * n_[1],
            {field[0], field[1], field[2]}, coefficient_.data(), degree_};
  }
  template <class Action> void dispatch(Action action) const
  {
    with_window_width<Real>(width_, action);
  }

  long particles_ = 0;
  DeviceArray<double, Exec> x_;

 private:
  /// In fractional coordinates.
  AxisLines axis(int d) const { return {n_[d], 0.0, 1.0 / n_[d], false, 0.0, 0.0}; }

  template <int W> void spread_width(const double *force, const View &field)
  {
    using Tile = SpreadTile<Real, W, Exec>;
    const std::size_t scratch = Tile::Scratch::shmem_size(Tile::cells);
    const double by_particle = 1.0 * particles_ * W * W * W,
                 by_tile = 1.0 * tiles_.count() * Tile::cells * slab_.count / n_[2];
    const bool fits = scratch <= most_scratch();
    if (particles_ == 0) return;
    if (!fits || by_ == SpreadBy::particles ||
        (by_ == SpreadBy::automatic && by_particle <= by_tile)) {
      device_for<Exec>("bdh::spread_window", particles_ * W,
                       SpreadPlane<Real, W>{window(field), x_.data(), force});
      return;
    }
    sort();
    const int league = dof * tiles_.count();
    Kokkos::TeamPolicy<Exec> policy(league, team_size());
    policy.set_scratch_size(0, Kokkos::PerTeam(scratch));
    Kokkos::parallel_for(
        "bdh::spread_tiles", policy,
        Tile{window(field), tiles_, x_.data(), force, begin_.data(), order_.data()});
  }

  void sort()
  {
    if (sorted_) return;
    sorted_ = true;
    const std::size_t tiles = tiles_.count();
    members_.resize(tiles);
    members_.clear_values();
    begin_.resize(tiles + 1);
    next_.resize(tiles);
    order_.resize(particles_);
    device_for<Exec>("bdh::count_in_tiles", particles_,
                     CountInTiles{tiles_, x_.data(), members_.data()});
    Kokkos::parallel_scan("bdh::sum_tiles",
                          Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, tiles_.count()),
                          SumTiles{members_.data(), begin_.data(), next_.data(), tiles_.count()});
    device_for<Exec>("bdh::sort_into_tiles", particles_,
                     SortIntoTiles{tiles_, x_.data(), next_.data(), order_.data()});
  }

  /// Bytes that a team may ask for; newer releases of Kokkos refuse more on a host.
  static std::size_t most_scratch()
  {
    if constexpr (host_memory<Exec>)
      return std::min<std::size_t>(fast_memory, Kokkos::TeamPolicy<Exec>::scratch_size_max(0));
    else
      return fast_memory;
  }
  static int team_size() { return host_memory<Exec> ? 1 : 128; }

  // Every GPU gives a team 48 KiB by default, minus what the runtime keeps for itself.
  static constexpr std::size_t fast_memory = 47 * 1024;

  std::array<long, dim> n_;
  Slab slab_;
  SpreadBy by_;
  int width_ = 0, degree_ = 0;
  Tiles tiles_;
  bool sorted_ = false;
  DeviceArray<Real, Exec> coefficient_;
  DeviceArray<int, Exec> members_, begin_, next_, order_;
};

}    // namespace bdh
#endif
