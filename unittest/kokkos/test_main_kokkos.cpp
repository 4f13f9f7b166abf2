// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// main() for tests that run on a Kokkos execution space without LAMMPS.  BDH_TEST_THREADS is the
// number of threads.

#include "support/kokkos_threads.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <mpi.h>

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  const char *threads = std::getenv("BDH_TEST_THREADS");
  bdh_test::initialize_kokkos(threads ? std::atoi(threads) : 1);
  const int result = RUN_ALL_TESTS();
  Kokkos::finalize();
  MPI_Finalize();
  return result;
}
