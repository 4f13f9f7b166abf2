// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Contribution of the ghost values behind moving walls to the interpolated velocity, which plain
/// interpolation leaves out (see fib/moving_walls.h).
#ifndef BDH_FIB_GHOST_KERNEL_H
#define BDH_FIB_GHOST_KERNEL_H

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

/// For each particle: velocity += 2 V times the weight behind each wall.
template <class Kernel> struct AddGhostVelocity {
  int dim;
  AxisLines axis[3];
  double V[3][2][3];    ///< wall velocities [axis][lower, upper][component]; 0 for walls at rest
  const double *x;      ///< positions, between the walls
  double *velocity;

  BDH_FN double cells(long i, int a) const { return (x[3 * i + a] - axis[a].lo) / axis[a].h; }

  BDH_FN void operator()(long i) const
  {
    for (int a = 0; a < dim; ++a)
      for (int side = 0; side < 2; ++side) {
        const double *const v = V[a][side];
        if (v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0) continue;
        const double y = cells(i, a), distance = side ? axis[a].n - y : y;
        if (distance > 0.5 * Kernel::width) continue;
        const double behind = weigh<Kernel>(y, 0.5, BehindWall{axis[a], side});
        for (int d = 0; d < dim; ++d) velocity[3 * i + d] += ghost(i, a, d, 2.0 * v[d] * behind);
      }
  }

  /// Component d of a ghost value, reduced by the mirror images in other walls.
  BDH_FN double ghost(long i, int a, int d, double value) const
  {
    for (int other = 0; other < dim && value != 0.0; ++other)
      if (other != a && axis[other].walled)
        value *= weigh<Kernel>(cells(i, other), other == d ? 0.0 : 0.5,
                               ShareOfWall{axis[other], other == d});
    return value;
  }
};

}    // namespace bdh
#endif
