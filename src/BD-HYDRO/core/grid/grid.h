// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The staggered grid, its boundaries, and the part of it that a rank owns.
#ifndef BDH_GRID_GRID_H
#define BDH_GRID_GRID_H

#include <array>

namespace bdh {

/// What a face of the box is: open to the periodic image, or a wall with or without friction.
enum class Boundary { periodic, noslip, slip };

/// Staggered grid.  Faces of component d lie at lo_d + i h_d along d and (i + 1/2) h along the
/// others.  Between walls the faces 1 .. n - 1 are unknowns; face 0, a wall, keeps its place in the
/// arrays and always holds 0.
struct Grid {
  int dim = 3;                       ///< 2 or 3; in 2D the third entries are n = 1, length = 1
  std::array<long, 3> n{1, 1, 1};    ///< cells per axis
  std::array<double, 3> lo{0.0, 0.0, 0.0};        ///< lower corner of the box [length]
  std::array<double, 3> length{1.0, 1.0, 1.0};    ///< box sides [length]
  /// The lower and the upper face of each axis.  Both of them are periodic, or neither.
  std::array<std::array<Boundary, 2>, 3> boundary{};

  double h(int d) const { return length[d] / n[d]; }
  long cells() const { return n[0] * n[1] * n[2]; }
  /// Volume of a cell [length^dim].  In 2D everything is per unit length of the third direction.
  double cell_volume() const { return h(0) * h(1) * (dim == 3 ? h(2) : 1.0); }
  int slow_axis() const { return dim - 1; }
  bool walled(int d) const { return boundary[d][0] != Boundary::periodic; }
  int walled_axes() const { return int(walled(0)) + int(walled(1)) + int(walled(2)); }
  /// Modes per row of the half-complex transforms along x.
  long half() const { return n[0] / 2 + 1; }
};

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
