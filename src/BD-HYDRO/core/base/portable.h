// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The one place where host and device compilation differ for pointwise code (layer L0).  A
/// function that is called in a loop which must be vectorised is BDH_FN_IN_LOOP: one call that is
/// not inlined would stop that.
#ifndef BDH_BASE_PORTABLE_H
#define BDH_BASE_PORTABLE_H

#if defined(LMP_KOKKOS)
#include <Kokkos_Macros.hpp>
#define BDH_FN KOKKOS_INLINE_FUNCTION
#define BDH_FN_IN_LOOP KOKKOS_FORCEINLINE_FUNCTION
#else
#define BDH_FN inline
#if defined(__GNUC__)
#define BDH_FN_IN_LOOP inline __attribute__((always_inline))
#else
#define BDH_FN_IN_LOOP inline
#endif
#endif

// Promises that the iterations of the next loop are independent.  It is not `omp simd`, which puts
// the small structs of Random123 into memory, so that g++ 12 gives up on the loop (10.5 ns a call
// instead of 4.4).
#if defined(__GNUC__) && !defined(__clang__)
#define BDH_INDEPENDENT _Pragma("GCC ivdep")
#else
#define BDH_INDEPENDENT
#endif

#endif
