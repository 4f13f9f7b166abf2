// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Strips of Fourier modes and their random numbers, shared by all loops over modes.
#ifndef BDH_STOKES_MODE_STRIP_H
#define BDH_STOKES_MODE_STRIP_H

#include "base/constants.h"
#include "base/random_strip.h"
#include "base/rng_kernel.h"
#include "base/single_normals_kernel.h"

#include <algorithm>
#include <cstdint>

namespace bdh {

/// Number of modes handled together.  Their buffers stay in the first-level cache.
constexpr long strip = 64;
/// Loops over a strip run to a multiple of this: the doubles in the widest vector registers, or the
/// floats in half of one.
constexpr long lanes = 8;

inline long padded(long count) { return (count + lanes - 1) / lanes * lanes; }

/// Real and imaginary parts of all components in a strip of modes.
template <class Real> struct StripField {
  alignas(64) Real re[3][strip], im[3][strip];
};

/// Normals for a strip.  z[m] is real or imaginary part number m.
template <class Real> struct StripNormals {
  alignas(64) Real z[4][strip];
};

/// Adds weight * normals of one draw to `out` for the modes index(0) .. index(count - 1), and for
/// some more that pad the strip.  E|z|^2 = 1 per complex number: each part has variance 1/2.
template <class Index, class Real> void add_draw(const NoiseCounter &counter, double weight,
                                                 Index index, long count, StripNormals<Real> &out)
{
  count = padded(count);    // a remainder loop would cost as much as a full strip
  const Real part = weight * root_half;
  // The numbers come in two loops because g++ vectorises each of them, but not both merged into
  // one.
  alignas(64) uint64_t number[strip];
  alignas(64) uint32_t w[4][strip];
  for (long i = 0; i < count; ++i) number[i] = index(i);
  random_words_of(counter, number, count, {w[0], w[1], w[2], w[3]});
  BDH_INDEPENDENT
  for (long i = 0; i < count; ++i) {
    Real z0, z1, z2, z3;
    normal_pair(w[0][i], w[1][i], z0, z1);
    normal_pair(w[2][i], w[3][i], z2, z3);
    out.z[0][i] += part * z0;
    out.z[1][i] += part * z1;
    out.z[2][i] += part * z2;
    out.z[3][i] += part * z3;
  }
}

/// The same of all draws that the normals of a step, or of a piece of it, consist of.
template <class Index, class Real> void add_normals(const NoiseCounter &counter, double weight,
                                                    Index index, long count,
                                                    StripNormals<Real> &out)
{
  const TermsOfPiece terms(counter);
  for (int m = 0; m <= terms.depth; ++m)
    add_draw(terms.counter(m), weight * terms.weight(m), index, count, out);
}

}    // namespace bdh
#endif
