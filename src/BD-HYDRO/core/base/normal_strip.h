// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The normal random numbers of many draws at once, in strips.
#ifndef BDH_BASE_NORMAL_STRIP_H
#define BDH_BASE_NORMAL_STRIP_H

#include "base/constants.h"
#include "base/random_strip.h"
#include "base/rng_kernel.h"
#include "base/single_normals_kernel.h"

#include <algorithm>
#include <cstdint>

namespace bdh {

/// Number of draws, or modes, handled together.  Their buffers stay in the first-level cache.
constexpr long strip = 64;
/// Loops over a strip run to a multiple of this: the doubles in the widest vector registers, or the
/// floats in half of one.
constexpr long lanes = 8;

inline long padded(long count) { return (count + lanes - 1) / lanes * lanes; }

/// Normals for a strip.  z[m] is real or imaginary part number m.
template <class Real> struct StripNormals {
  alignas(64) Real z[4][strip];
};

/// Adds `factor` times the four normals of each of the draws index(0) .. index(count - 1) of one
/// counter, and of some more that pad the strip.
template <class Index, class Real> void add_draw(const NoiseCounter &counter, Real factor,
                                                 Index index, long count, StripNormals<Real> &out)
{
  count = padded(count);    // a remainder loop would cost as much as a full strip
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
    out.z[0][i] += factor * z0;
    out.z[1][i] += factor * z1;
    out.z[2][i] += factor * z2;
    out.z[3][i] += factor * z3;
  }
}

/// The same of all draws that the normals of a step, or of a piece of it, consist of.
template <class Index, class Real> void add_draws(const NoiseCounter &counter, double factor,
                                                  Index index, long count, StripNormals<Real> &out)
{
  const TermsOfPiece terms(counter);
  for (int m = 0; m <= terms.depth; ++m)
    add_draw(terms.counter(m), static_cast<Real>(factor * terms.weight(m)), index, count, out);
}

/// Calls action(i, z) with the normals z[0] .. z[3] of draw index[i], for i = begin .. end - 1.
template <class Action> void for_draws_in(long begin, long end, const NoiseCounter &counter,
                                          const uint64_t *index, const Action &action)
{
  for (long first = begin; first < end; first += strip) {
    const long count = std::min(strip, end - first);
    StripNormals<double> normals{};
    // What pads the strip repeats the last draw.
    add_draws(
        counter, 1.0, [=](long i) { return index[first + std::min(i, count - 1)]; }, count,
        normals);
    for (long i = 0; i < count; ++i) {
      const double z[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
      action(first + i, z);
    }
  }
}

}    // namespace bdh
#endif
