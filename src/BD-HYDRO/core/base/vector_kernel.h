// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Pointwise operations on arrays of numbers, and of particles (3 numbers each, x, y, z
/// interleaved).
#ifndef BDH_BASE_VECTOR_KERNEL_H
#define BDH_BASE_VECTOR_KERNEL_H

#include "base/portable.h"

namespace bdh {

/// to := a x b
template <class Real> BDH_FN void cross_product(const Real *a, const Real *b, Real *to)
{
  to[0] = a[1] * b[2] - a[2] * b[1];
  to[1] = a[2] * b[0] - a[0] * b[2];
  to[2] = a[0] * b[1] - a[1] * b[0];
}

/// a . b
template <class Real> BDH_FN Real scalar_product(const Real *a, const Real *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

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

/// Of the `slots` numbers of a particle, those from `first` on := normals of its draw, `count` of
/// them, and `zeros` zeros behind them; by draw.
template <class Real> struct StoreNormals {
  Real *to;
  int slots, first, count, zeros;
  BDH_FN void operator()(long i, const double *z) const
  {
    Real *const at = to + slots * i + first;
    for (int c = 0; c < count; ++c) at[c] = z[c];
    for (int c = count; c < count + zeros; ++c) at[c] = Real(0);
  }
};

/// v += amplitude times three normals of the particle (two if dim is 2), by draw.
struct AddNormals {
  double amplitude;
  int dim;
  double *v;
  BDH_FN void operator()(long i, const double *z) const
  {
    for (int c = 0; c < dim; ++c) v[3 * i + c] += amplitude * z[c];
  }
};

/// True for a particle with a number that is not finite.
struct NotFinite {
  const double *v;
  BDH_FN bool operator()(long i) const
  {
    // The difference is NaN for inf - inf and NaN - NaN.
    const double zero =
        (v[3 * i] - v[3 * i]) + (v[3 * i + 1] - v[3 * i + 1]) + (v[3 * i + 2] - v[3 * i + 2]);
    return !(zero == 0.0);
  }
};

}    // namespace bdh
#endif
