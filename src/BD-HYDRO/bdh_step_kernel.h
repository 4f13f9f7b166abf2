// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a time step: what a backend does for each number, or each particle.
///
/// Arrays of n particles have 3 n entries, x, y, z interleaved.
#ifndef BDH_STEP_KERNEL_H
#define BDH_STEP_KERNEL_H

#include "bdh_rng_kernel.h"

#include <cmath>

namespace bdh {

/// v := 0, by number.
struct Clear {
  double *v;
  BDH_FN void operator()(long k) const { v[k] = 0.0; }
};

/// to := ca a + cb b, by number.
struct Combine {
  double ca;
  const double *a;
  double cb;
  const double *b;
  double *to;
  BDH_FN void operator()(long k) const { to[k] = ca * a[k] + cb * b[k]; }
};

/// to := c a, by number.
template <class Real> struct Scale {
  Real c;
  const Real *a;
  Real *to;
  BDH_FN void operator()(long k) const { to[k] = c * a[k]; }
};

/// to := x - q where a wall has mirrored x, by number; elsewhere it stays.
struct TakeMirrored {
  const char *mirrored;
  const double *x, *q;
  double *to;
  BDH_FN void operator()(long k) const
  {
    if (mirrored[k]) to[k] = x[k] - q[k];
  }
};

/// u += velocity that changes linearly along an axis, by particle.
struct AddLinearFlow {
  int axis;
  double origin, at_origin[3], gradient[3];
  const double *x;
  double *u;
  BDH_FN void operator()(long i) const
  {
    const double y = x[3 * i + axis] - origin;
    for (int c = 0; c < 3; ++c) u[3 * i + c] += at_origin[c] + gradient[c] * y;
  }
};

/// w := three normals of the particle, by particle.
struct DrawNormals {
  NoiseCounter counter;
  const uint64_t *id;
  double *w;
  BDH_FN void operator()(long i) const
  {
    double spare;
    normal4(counter, id[i], w[3 * i], w[3 * i + 1], w[3 * i + 2], spare);
  }
};

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

/// True for a particle with a number that is not finite.
struct NotFinite {
  const double *v;
  BDH_FN bool operator()(long i) const
  {
    // inf - inf and NaN - NaN are NaN
    const double zero = (v[3 * i] - v[3 * i]) + (v[3 * i + 1] - v[3 * i + 1]) + (v[3 * i + 2] - v[3 * i + 2]);
    return !(zero == 0.0);
  }
};

/// Where particles may be.
struct WallLimits {
  int dim;
  bool walled[3];
  double lo[3], hi[3];    ///< [length]
};

/// True for a particle that is beyond a wall, or nowhere.
struct BeyondWalls {
  WallLimits walls;
  const double *x;
  BDH_FN bool operator()(long i) const
  {
    for (int d = 0; d < walls.dim; ++d)
      if (walls.walled[d] && !(x[3 * i + d] >= walls.lo[d] && x[3 * i + d] <= walls.hi[d])) return true;
    return false;
  }
};

/// True for a position that has no cell: not finite, astronomically far away, or beyond a wall.
struct HasNoCell {
  WallLimits walls;
  double lo[3], far[3];    ///< of the box; distance that is too far
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

/// Coordinates beyond a wall := their mirror images, and marked; by particle.  The result is how many.
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
