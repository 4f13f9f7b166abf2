// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Vector registers of the processor that is compiled for, and vectors of numbers for them.
#ifndef BDH_BASE_REGISTERS_H
#define BDH_BASE_REGISTERS_H

#include <cstring>
#include <utility>

namespace bdh {

/// Bytes of one.  g++ 12 keeps longer vectors in memory where several live at once, and takes
/// shuffles of them apart.
#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif

/// The numbers of type Real that fit into one.
template <class Real> constexpr int lanes_of_register = register_bytes / int(sizeof(Real));

/// A vector of numbers, for +, *, and shuffles.
template <class Real, int lanes> using LanesOf __attribute__((vector_size(lanes * sizeof(Real)))) =
    Real;

/// The numbers from p on.
template <class Real, int lanes> LanesOf<Real, lanes> lanes_at(const Real *p)
{
  LanesOf<Real, lanes> v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

template <class Real, int lanes> void put_lanes(LanesOf<Real, lanes> v, Real *p)
{
  std::memcpy(p, &v, sizeof v);
}

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
