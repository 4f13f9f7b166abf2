// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Positions of particles (3 numbers each) in a box with or without walls.
#ifndef BDH_GRID_POSITION_KERNEL_H
#define BDH_GRID_POSITION_KERNEL_H

#include "base/portable.h"
#include "base/strain_kernel.h"

#include <cmath>

namespace bdh {

/// to := from with other names of the axes, by particle.
struct ReorderAxes {
  int axis[3];
  const double *from;
  double *to;
  BDH_FN void operator()(long i) const
  {
    for (int d = 0; d < 3; ++d) to[3 * i + d] = from[3 * i + axis[d]];
  }
};

/// The same for axial vectors, such as torques: an exchange of two axes changes their sign.
struct ReorderAxial {
  ReorderAxes axes;
  double sign;    ///< -1 if the order is that of an exchange
  BDH_FN void operator()(long i) const
  {
    axes(i);
    for (int d = 0; d < 3; ++d) axes.to[3 * i + d] *= sign;
  }
};

/// The same for symmetric traceless tensors in their five numbers.
struct ReorderTensors {
  ReorderAxes axes;
  BDH_FN void operator()(long i) const
  {
    const auto from = Symmetric<double>::of(axes.from + strain_numbers * i);
    double to[3][3];
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) to[c][d] = from.at(axes.axis[c], axes.axis[d]);
    strain_of(to, axes.to + strain_numbers * i);
  }
};

/// Where particles may be.
struct WallLimits {
  int dim;
  bool walled[3];
  double lo[3], hi[3];    ///< [length]; infinite where there is no limit
};

/// True for a particle that is beyond a wall, or nowhere.
struct BeyondWalls {
  WallLimits walls;
  const double *x;
  BDH_FN bool operator()(long i) const
  {
    for (int d = 0; d < walls.dim; ++d)
      if (walls.walled[d] && !(x[3 * i + d] >= walls.lo[d] && x[3 * i + d] <= walls.hi[d]))
        return true;
    return false;
  }
};

/// True for a position that has no cell: not finite, astronomically far away, or beyond a wall or
/// an open face.
struct HasNoCell {
  WallLimits walls;
  double lo[3], far[3];    ///< corner of the box; distances from it that are too far [length]
  const double *x;
  BDH_FN bool operator()(long i) const
  {
    for (int d = 0; d < walls.dim; ++d) {
      const double q = x[3 * i + d];
      if (!(std::fabs(q - lo[d]) < far[d])) return true;
      if (walls.walled[d] && (q < walls.lo[d] || q > walls.hi[d])) return true;
    }
    return false;
  }
};

/// Replaces coordinates of a particle that are beyond a wall by their mirror images, and marks
/// them.  Returns how many there are.
struct MirrorAtWalls {
  WallLimits walls;
  double *x;
  char *mirrored;
  BDH_FN double operator()(long i) const
  {
    double count = 0.0;
    for (int d = 0; d < walls.dim; ++d) {
      double &q = x[3 * i + d];
      if (!walls.walled[d] || (q >= walls.lo[d] && q <= walls.hi[d])) continue;
      q = q < walls.lo[d] ? 2.0 * walls.lo[d] - q : 2.0 * walls.hi[d] - q;
      mirrored[3 * i + d] = 1;
      count += 1.0;
    }
    return count;
  }
};

}    // namespace bdh
#endif
