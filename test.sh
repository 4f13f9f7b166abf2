#!/usr/bin/env bash
# From a fresh Debian 12 to all tests passed: the package as most will use it, then with Kokkos on OpenMP threads, then the
# device code through nvcc where there is one.  Arguments go to ctest, as in ./test.sh -R pair
#
#   BDH_TEST=plain ./test.sh    the first of the three only
set -euo pipefail
cd "$(dirname "$0")"
cmake/prepare.sh all
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
if [ "${BDH_TEST:-all}" = plain ]; then exit; fi

BDH_KOKKOS=openmp cmake/prepare.sh bdh_kokkos_tests lmp
ctest --test-dir build-kokkos-openmp -L kokkos --output-on-failure --parallel "$(nproc)" "$@"
cmake/check_cuda.sh
