// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a time step: what is done for each number, or each particle.
///
/// Arrays of n particles have 3 n entries, x, y, z interleaved.
#ifndef BDH_FIB_STEP_KERNEL_H
#define BDH_FIB_STEP_KERNEL_H

#include "base/portable.h"

namespace bdh {

/// to := x - q where a wall has mirrored x, by number.  Elsewhere `to` stays as it is.
struct TakeMirrored {
  const char *mirrored;
  const double *x, *q;
  double *to;
  BDH_FN void operator()(long k) const
  {
    if (mirrored[k]) to[k] = x[k] - q[k];
  }
};

/// u += a velocity that changes linearly along an axis, by particle.
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

/// to += v, by particle.
struct AddToEach {
  double v[3];
  double *to;
  BDH_FN void operator()(long i) const
  {
    for (int c = 0; c < 3; ++c) to[3 * i + c] += v[c];
  }
};

/// v := its third component, by particle.
struct KeepThird {
  double *v;
  BDH_FN void operator()(long i) const { v[3 * i] = v[3 * i + 1] = 0.0; }
};

}    // namespace bdh
#endif
