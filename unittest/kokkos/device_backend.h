// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The backend of typed tests that run on a Kokkos execution space whose memory the host can see.
// Exec: -D BDH_TEST_EXEC=Kokkos::OpenMP, ...; threads: environment, BDH_TEST_THREADS.

#include "fib/on_device_kokkos.h"
#include "support/test_support.h"

#include <type_traits>

#define TEST_BACKEND bdh::FibOnDevice<BDH_TEST_EXEC>
// The thousands of small solves that make a matrix spend their time in starting threads: these get
// some of the grids.
#define TEST_MATRIX_OF_EVERY (std::is_same<BDH_TEST_EXEC, Kokkos::Serial>::value ? 1 : 11)

namespace bdh_test {

template <> struct Access<TEST_BACKEND> {
  using Vector = TEST_BACKEND::Vector;
  static void put(const std::vector<double> &from, Vector &to)
  {
    to.assign(from.data(), from.size());
  }
  static std::vector<double> get(const Vector &from) { return from.to_host(); }
};

}    // namespace bdh_test
