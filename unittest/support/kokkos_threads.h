// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Kokkos with a number of threads, for programs without LAMMPS.
#ifndef BDH_TEST_KOKKOS_THREADS_H
#define BDH_TEST_KOKKOS_THREADS_H

#include <Kokkos_Core.hpp>

namespace bdh_test {

inline void initialize_kokkos(int threads)
{
#if KOKKOS_VERSION >= 30700
  Kokkos::initialize(Kokkos::InitializationSettings().set_num_threads(threads));
#else
  Kokkos::InitArguments arguments;
  arguments.num_threads = threads;
  Kokkos::initialize(arguments);
#endif
}

}    // namespace bdh_test
#endif
