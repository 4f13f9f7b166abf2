#!/usr/bin/env bash
# From a fresh Debian 12 to all tests passed: with Kokkos on OpenMP threads, its device code through nvcc where there is one,
# and last the package as most will use it, built from source and with Debian's own LAMMPS library.  Arguments go to ctest,
# as in ./test.sh -R pair
#
#   BDH_TEST=plain ./test.sh    without Kokkos
set -euo pipefail
cd "$(dirname "$0")"
cmake/prepare.sh all
BDH_LAMMPS=installed cmake/prepare.sh lmp_bdh
if [ "${BDH_TEST:-all}" != plain ]; then
  BDH_KOKKOS=openmp cmake/prepare.sh bdh_kokkos_tests lmp
  cmake/check_cuda.sh
  ctest --test-dir build-kokkos-openmp -L kokkos --output-on-failure --parallel "$(nproc)" "$@"
fi
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
