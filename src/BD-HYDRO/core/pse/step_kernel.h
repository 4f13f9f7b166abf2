// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a step with positively split Ewald: what is done for each number,
/// or each particle.
///
/// Arrays of n particles have 3 n entries, x, y, z interleaved; vectors of the real-space part have
/// 4 n, the last of each 0. What is kept by atom has `stride` numbers for each; local: the atom of
/// a particle.
#ifndef BDH_PSE_STEP_KERNEL_H
#define BDH_PSE_STEP_KERNEL_H

#include "base/vector_kernel.h"

namespace bdh {

/// to (4 per particle) := from (3 per particle), by particle.
template <class Real> struct LoadVector {
  const double *from;
  Real *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) to[4 * p + c] = static_cast<Real>(from[3 * p + c]);
    to[4 * p + 3] = Real(0);
  }
};
/// to (3) += factor * from (4), by particle.
template <class Real> struct AddVector {
  double factor;
  const Real *from;
  double *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) to[3 * p + c] += factor * static_cast<double>(from[4 * p + c]);
  }
};
/// to (4) := three normals, by particle.
template <class Real> struct DrawVector {
  NoiseCounter counter;
  const uint64_t *id;
  Real *to;
  BDH_FN void operator()(long p) const
  {
    double z[4];
    normal4(counter, id[p], z[0], z[1], z[2], z[3]);
    for (int c = 0; c < 3; ++c) to[4 * p + c] = static_cast<Real>(z[c]);
    to[4 * p + 3] = Real(0);
  }
};

/// True for a particle with a force.
struct HasForce {
  const double *f;
  BDH_FN bool operator()(long p) const
  {
    return f[3 * p] != 0.0 || f[3 * p + 1] != 0.0 || f[3 * p + 2] != 0.0;
  }
};
/// Three numbers of its atom := 0, by particle.
struct ClearKept {
  const int *local;
  long stride;
  double *kept;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) kept[stride * local[p] + c] = 0.0;
  }
};
/// Three numbers of its atom += v, by particle.
struct AddToKept {
  const int *local;
  long stride;
  const double *v;
  double *kept;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) kept[stride * local[p] + c] += v[3 * p + c];
  }
};
/// v := three numbers of its atom over a divisor, by particle.
struct DivideKept {
  const int *local;
  long stride;
  const double *kept;
  double divisor;
  double *v;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) v[3 * p + c] = kept[stride * local[p] + c] / divisor;
  }
};
/// displacement := h displacement + amplitude times the mean of two noises, by particle.  The last
/// one is kept by atom with a fourth number, 1 if there is one; this one takes its place.
struct NearStep {
  const int *local;
  long stride;
  double h, amplitude;
  const double *random;
  double *last, *displacement;
  BDH_FN void operator()(long p) const
  {
    double *l = last + stride * local[p];
    for (int c = 0; c < 3; ++c) {
      const double z = random[3 * p + c];
      displacement[3 * p + c] =
          h * displacement[3 * p + c] + amplitude * 0.5 * ((l[3] > 0.0 ? l[c] : z) + z);
      l[c] = z;
    }
    l[3] = 1.0;
  }
};

}    // namespace bdh
#endif
