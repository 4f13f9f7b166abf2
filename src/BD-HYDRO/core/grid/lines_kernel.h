// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Grid lines of one axis: where a position lies among them, and which stored line holds the values
/// of one outside.
///
/// Lines are those of the faces normal to the axis (line i at i h), or those through the cell
/// centres (at (i + 1/2) h). Beyond a wall a line holds its mirror image, with a sign: minus for
/// every component at a no-slip wall; at a free-slip wall minus for the normal component (its
/// faces) and plus for the others.                           [FIB sec. III A]
/// Behind an open end there are no images.  No kernel reaches so far, nor to the face in the end.
#ifndef BDH_GRID_LINES_KERNEL_H
#define BDH_GRID_LINES_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// An axis of a grid.
struct AxisLines {
  long n;          ///< cells
  double lo, h;    ///< lower end and spacing [length]
  bool walled;
  double below, above;    ///< signs of the images of centre lines beyond either end; 0: open
};

/// i mod n, in 0 .. n - 1.
BDH_FN long wrap_line(long i, long n)
{
  i %= n;
  return i < 0 ? i + n : i;
}

/// The line within the box that holds the values of line i.  Face n, a wall, is not stored and gets
/// the place of face 0.
BDH_FN long stored_line(const AxisLines &a, bool faces, long i)
{
  if (!a.walled) return wrap_line(i, a.n);
  // Mirrors at both walls make a lattice of period 2 n.
  const long j = wrap_line(i, 2 * a.n), mirrored = (faces ? 2 * a.n : 2 * a.n - 1) - j;
  const long line = j < mirrored ? j : mirrored;
  return faces && line == a.n ? 0 : line;
}

/// The factor of the weight at line i: the sign of an image, 0 for faces that are walls.
BDH_FN double line_sign(const AxisLines &a, bool faces, long i)
{
  if (!a.walled) return 1.0;
  if (faces) return i == 0 || i == a.n ? 0.0 : i < 0 || i > a.n ? -1.0 : 1.0;
  return i < 0 ? a.below : i >= a.n ? a.above : 1.0;
}

/// Position in spacings from the lower end.  On a periodic axis it is that of the image in the box,
/// and one that rounds to n becomes 0.
BDH_FN double cells_from_end(const AxisLines &a, double x)
{
  const double period = a.n, shift = a.walled ? 0.0 : period;
  const double cells = (x - a.lo) / a.h, inside = cells - shift * std::floor(cells / period);
  return inside < period || a.walled ? inside : 0.0;
}

}    // namespace bdh
#endif
