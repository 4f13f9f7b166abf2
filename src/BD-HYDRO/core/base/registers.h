// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Vector registers of the processor that is compiled for, and vectors of numbers for them.
#ifndef BDH_BASE_REGISTERS_H
#define BDH_BASE_REGISTERS_H

#include <cstring>

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

}    // namespace bdh
#endif
