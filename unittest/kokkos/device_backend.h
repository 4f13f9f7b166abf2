// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The backend of typed tests on a Kokkos execution space whose memory is accessible to the host.
// -D BDH_TEST_EXEC=Kokkos::OpenMP, ... selects the space, and the environment variable
// BDH_TEST_THREADS the number of threads.

#include "fib/on_device_kokkos.h"
#include "support/test_support.h"

#define TEST_BACKEND bdh::FibOnDevice<BDH_TEST_EXEC>
// A matrix takes thousands of small solves, which with several threads spend their time starting
// them.  Several threads therefore measure only some of the grids.
#define TEST_MATRIX_OF_EVERY (BDH_TEST_EXEC().concurrency() == 1 ? 1 : 11)

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
