// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Eight numbers side by side.
#ifndef BDH_BASE_OCTET_KERNEL_H
#define BDH_BASE_OCTET_KERNEL_H

#include "base/portable.h"

// Vector registers of a host, as g++ and clang have them; not of the compilers for devices.
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#define BDH_VECTORS 1
#else
#define BDH_VECTORS 0
#endif

namespace bdh {

/// Eight numbers side by side, on a host in vector registers.  (g++ 12 unrolls loops over so few
/// numbers before it could make vectors of them.)
template <class Real> struct Octet {
#if BDH_VECTORS
  typedef Real Lanes __attribute__((vector_size(8 * sizeof(Real))));
  Lanes v;
  BDH_FN void load(const Real *from) { __builtin_memcpy(&v, from, sizeof v); }
  BDH_FN void store(Real *to) const { __builtin_memcpy(to, &v, sizeof v); }
  /// v := v u + c
  BDH_FN void step(Real u, const Real *c)
  {
    Octet more;
    more.load(c);
    v = v * u + more.v;
  }
#else
  Real v[8];
  BDH_FN void load(const Real *from)
  {
    for (int k = 0; k < 8; ++k) v[k] = from[k];
  }
  BDH_FN void store(Real *to) const
  {
    for (int k = 0; k < 8; ++k) to[k] = v[k];
  }
  BDH_FN void step(Real u, const Real *c)
  {
    for (int k = 0; k < 8; ++k) v[k] = v[k] * u + c[k];
  }
#endif
};

}    // namespace bdh

#endif
