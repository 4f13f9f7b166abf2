// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Shuffles of vectors of numbers.  Device code cannot include them: nvcc takes them apart.
#ifndef BDH_BASE_SHUFFLES_H
#define BDH_BASE_SHUFFLES_H

#include "base/registers.h"

#include <utility>

namespace bdh {

/// a and b as one vector.  The shuffles compile to insertions, where copies through memory would
/// wait for the stores.
template <class Real, int lanes, int... i> LanesOf<Real, 2 * lanes>
joined(LanesOf<Real, lanes> a, LanesOf<Real, lanes> b, std::integer_sequence<int, i...>)
{
  return __builtin_shufflevector(a, b, i...);
}

/// As many numbers of v as the sequence has, from number `begin` on.
template <class Real, int all, int begin, int... i>
LanesOf<Real, sizeof...(i)> part_of(LanesOf<Real, all> v, std::integer_sequence<int, i...>)
{
  return __builtin_shufflevector(v, v, (begin + i)...);
}

/// Sum of all lanes, halves first.
template <class Real, int lanes> Real sum_of(LanesOf<Real, lanes> v)
{
  if constexpr (lanes == 2) {
    return v[0] + v[1];
  } else {
    using Half = std::make_integer_sequence<int, lanes / 2>;
    return sum_of<Real, lanes / 2>(part_of<Real, lanes, 0>(v, Half()) +
                                   part_of<Real, lanes, lanes / 2>(v, Half()));
  }
}

}    // namespace bdh
#endif
