// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Contribution of the ghost values behind moving walls to the interpolated velocity, which plain
/// interpolation leaves out (see fib/moving_walls.h).
#ifndef BDH_FIB_GHOST_KERNEL_H
#define BDH_FIB_GHOST_KERNEL_H

#include "fib/turning_kernel.h"
#include "grid/lines_kernel.h"

namespace bdh {

/// 1 for the centre lines behind a wall.
struct BehindWall {
  const AxisLines &axis;
  int side;
  BDH_FN double operator()(long line) const
  {
    return (side ? line >= axis.n : line < 0) ? 1.0 : 0.0;
  }
};

/// Fraction of a wall's velocity that the ghost values on a line of another axis contain.
/// `faces` says whether the lines are the faces of the component's own axis.
struct ShareOfWall {
  const AxisLines &axis;
  bool faces;
  BDH_FN double operator()(long line) const
  {
    if (!axis.walled) return 1.0;
    const double below = axis.below > 0.0 ? 1.0 : 0.0, above = axis.above > 0.0 ? 1.0 : 0.0;
    if (!faces) return line < 0 ? below : line >= axis.n ? above : 1.0;
    return line == 0 || line == axis.n ? 0.0 : line < 0 ? -below : line > axis.n ? -above : 1.0;
  }
};

/// Sum of weight times share(line) over the lines under a particle at x, in spacings.  `shift` is 0
/// for faces and 1/2 for centres.
template <class Kernel, class Share> BDH_FN double weigh(double x, double shift, const Share &share)
{
  double r, w[Kernel::width], sum = 0.0;
  const long first = static_cast<long>(Kernel::first(x - shift, r));
  Kernel::weights(r, w);
  for (int i = 0; i < Kernel::width; ++i) sum += w[i] * share(first + i);
  return sum;
}

/// Where the walls are, and how they move.
struct GhostsOfWalls {
  int dim;
  AxisLines axis[3];
  double V[3][2][3];    ///< wall velocities [axis][lower, upper][component]; 0 for walls at rest
  const double *x;      ///< positions, between the walls
  double *to;           ///< velocities or angular velocities

  BDH_FN double cells(long i, int a) const { return (x[3 * i + a] - axis[a].lo) / axis[a].h; }
  /// True if a kernel of this width reaches the wall, and the wall moves.
  BDH_FN bool matter(long i, int a, int side, int width) const
  {
    const double *const v = V[a][side];
    const double y = cells(i, a), distance = side ? axis[a].n - y : y;
    return (v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0) && distance <= 0.5 * width;
  }
};

/// For each particle: velocity += 2 V times the weight behind each wall.
template <class Kernel> struct AddGhostVelocity {
  GhostsOfWalls walls;

  BDH_FN void operator()(long i) const
  {
    for (int a = 0; a < walls.dim; ++a)
      for (int side = 0; side < 2; ++side) {
        if (!walls.matter(i, a, side, Kernel::width)) continue;
        const double behind =
            weigh<Kernel>(walls.cells(i, a), 0.5, BehindWall{walls.axis[a], side});
        for (int d = 0; d < walls.dim; ++d)
          walls.to[3 * i + d] += ghost(i, a, d, 2.0 * walls.V[a][side][d] * behind);
      }
  }

  /// Component d of a ghost value, reduced by the mirror images in other walls.
  BDH_FN double ghost(long i, int a, int d, double value) const
  {
    for (int other = 0; other < walls.dim && value != 0.0; ++other)
      if (other != a && walls.axis[other].walled)
        value *= weigh<Kernel>(walls.cells(i, other), other == d ? 0.0 : 0.5,
                               ShareOfWall{walls.axis[other], other == d});
    return value;
  }
};

/// For each particle: angular velocity += half the average of the curl of 2 V behind each wall.
/// K: the kernel of torques.
template <class K> struct AddGhostRotation {
  GhostsOfWalls walls;

  BDH_FN void operator()(long i) const
  {
    for (int a = 0; a < walls.dim; ++a)
      for (int side = 0; side < 2; ++side) {
        if (!walls.matter(i, a, side, TurningWeights<K>::width)) continue;
        for (int c = 0; c < walls.dim; ++c)
          for (int term = 0; term < 2; ++term) add(i, a, side, c, TurningTerm(c, term));
      }
  }

 private:
  BDH_FN void add(long i, int a, int side, int c, const TurningTerm &term) const
  {
    if (term.difference >= walls.dim) return;
    double value = term.factor * 2.0 * walls.V[a][side][c];
    for (int d = 0; d < walls.dim && value != 0.0; ++d) value *= share(i, a, side, c, term, d);
    walls.to[3 * i + term.torque] += value;
  }

  /// The factor of axis d.
  BDH_FN double share(long i, int a, int side, int c, const TurningTerm &term, int d) const
  {
    const TurningWeights<K> w(walls.cells(i, d), walls.axis[d].h);
    const double *const weights = d == c ? w.face : d == term.difference ? w.difference : w.centre;
    const long first = d == c ? w.first_face : w.first_centre();
    const BehindWall behind{walls.axis[d], side};
    const ShareOfWall of_wall{walls.axis[d], d == c};
    double sum = 0.0;
    for (int k = 0; k < TurningWeights<K>::width; ++k)
      sum += weights[k] * (d == a ? behind(first + k) : of_wall(first + k));
    return sum;
  }
};

}    // namespace bdh
#endif
