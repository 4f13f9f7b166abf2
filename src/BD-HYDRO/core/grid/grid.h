// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The staggered grid, its boundaries, and the part of it that a rank owns.
#ifndef BDH_GRID_GRID_H
#define BDH_GRID_GRID_H

#include "grid/boundary.h"

#include <array>
#include <stdexcept>

namespace bdh {

/// Staggered grid.  Faces of component d lie at lo_d + i h_d along d and (i + 1/2) h along the
/// others.  Between walls the faces 1 .. n - 1 are unknowns; face 0, a wall, keeps its place in the
/// arrays and always holds 0.  At an open face the grid goes on beyond the box by a few rows, so
/// that no kernel of a particle in the box reaches over its end: see beyond_open_faces().  Face 0
/// of a grid that is open at its lower end is an unknown.
struct Grid {
  int dim = 3;                       ///< 2 or 3; in 2D the third entries are n = 1, length = 1
  std::array<long, 3> n{1, 1, 1};    ///< cells per axis
  std::array<double, 3> lo{0.0, 0.0, 0.0};        ///< lower corner [length]
  std::array<double, 3> length{1.0, 1.0, 1.0};    ///< sides [length]
  /// The lower and the upper face of each axis.  Both of them are periodic, or neither.
  std::array<std::array<Boundary, 2>, 3> boundary{};
  /// How far the grid goes on beyond each face of the box [length]; 0 except at open faces.
  std::array<std::array<double, 2>, 3> beyond{};
  /// How far the box goes on beyond the region where kernels fit into the grid [length]; 0 except
  /// at open faces of a grid that has only a part of the rows: see lowest_rows().
  std::array<std::array<double, 2>, 3> left_out{};

  double h(int d) const { return length[d] / n[d]; }
  long cells() const { return n[0] * n[1] * n[2]; }
  /// Volume of a cell [length^dim].  In 2D everything is per unit length of the third direction.
  double cell_volume() const { return h(0) * h(1) * (dim == 3 ? h(2) : 1.0); }
  int slow_axis() const { return dim - 1; }
  /// True for an axis that ends at walls or open faces.
  bool walled(int d) const { return boundary[d][0] != Boundary::periodic; }
  /// True if one of the two faces of an axis is of this kind.
  bool has(Boundary kind, int d) const { return boundary[d][0] == kind || boundary[d][1] == kind; }
  /// True if any face of the box is open.
  bool opens() const
  {
    return has(Boundary::open, 0) || has(Boundary::open, 1) || has(Boundary::open, 2);
  }
  /// Where kernels of particles lie within the grid [length].
  double fit_lo(int d) const { return lo[d] + beyond[d][0]; }
  double fit_hi(int d) const { return lo[d] + length[d] - beyond[d][1]; }
  /// The faces of the box [length].
  double box_lo(int d) const { return fit_lo(d) - left_out[d][0]; }
  double box_hi(int d) const { return fit_hi(d) + left_out[d][1]; }
  /// True if the grid leaves out a part of the box.
  bool leaves_out() const { return left_out != std::array<std::array<double, 2>, 3>{}; }
  int walled_axes() const { return int(walled(0)) + int(walled(1)) + int(walled(2)); }
  /// Modes per row of the half-complex transforms along x.
  long half() const { return n[0] / 2 + 1; }
};

/// The grid of a box, and `rows` more beyond each of its open faces.
inline Grid beyond_open_faces(Grid g, long rows)
{
  for (std::size_t d = 0; d < 3; ++d) {
    const double more = rows * g.h(d);
    for (std::size_t side = 0; side < 2; ++side) {
      if (g.boundary[d][side] != Boundary::open) continue;
      g.n[d] += rows;
      g.length[d] += more;
      g.beyond[d][side] += more;
      if (side == 0) g.lo[d] -= more;
    }
  }
  return g;
}

/// The `rows` rows of a box next to the wall that lies opposite to an open face normal to `axis`.
inline Grid lowest_rows(const Grid &whole, int axis, long rows)
{
  Grid g = whole;
  const std::size_t d = axis, open = whole.boundary[d][0] == Boundary::open ? 0 : 1;
  const double h = whole.h(axis), less = (whole.n[d] - rows) * h;
  g.n[d] = rows;
  g.length[d] = rows * h;
  g.left_out[d][open] += less;
  if (open == 0) g.lo[d] += less;
  return g;
}

/// For solvers that know walls, but no open faces: is it a no-slip wall?  Throws std::logic_error
/// for an open face.
inline bool is_noslip_wall(Boundary kind)
{
  if (kind == Boundary::open) throw std::logic_error("this solver cannot have open faces");
  return kind == Boundary::noslip;
}

/// Three components for each wall of a box, [axis][lower, upper][component].
using WallVectors = std::array<std::array<std::array<double, 3>, 2>, 3>;

/// Arrays of a staggered vector field on this rank's slab, in the layout of VectorFft.
using FieldView = std::array<double *, 3>;

/// Planes of the slow axis that a rank owns.
struct Slab {
  long start = 0, count = 0;
  bool contains(long plane) const { return plane >= start && plane < start + count; }
};

}    // namespace bdh
#endif
