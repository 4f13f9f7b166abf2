#!/usr/bin/env bash
# Installs, builds and tests everything on a fresh Debian 12.  First come the tests with Kokkos on OpenMP threads and, if
# there is an nvcc, the compilation of the device code.  Then the package is tested in its usual forms: with LAMMPS built from
# source, and with Debian's LAMMPS library.  Arguments are passed on to ctest, as in ./test.sh -R pair
#
#   BDH_TEST=plain ./test.sh    without Kokkos
set -euo pipefail
cd "$(dirname "$0")"
# The first build is what takes longest here; -DBDH_PRECOMPILED_HEADERS=OFF in $BDH_CMAKE_ARGS undoes this.
export BDH_CMAKE_ARGS="-DBDH_PRECOMPILED_HEADERS=ON ${BDH_CMAKE_ARGS:-}"
cmake/prepare.sh all
BDH_LAMMPS=installed cmake/prepare.sh lmp_bdh
if [ "${BDH_TEST:-all}" != plain ]; then
  BDH_KOKKOS=openmp cmake/prepare.sh bdh_kokkos_tests lmp
  cmake/check_cuda.sh
  cmake/check_newest_headers.sh
  ctest --test-dir build-kokkos-openmp -L kokkos --output-on-failure --parallel "$(nproc)" "$@"
fi
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
