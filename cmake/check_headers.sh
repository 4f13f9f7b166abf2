#!/usr/bin/env bash
# Checks that all files that use LAMMPS compile with the headers of a release, without building anything.
#
#   cmake/check_headers.sh DIR            DIR: a LAMMPS source tree, or the headers of an installed library
#   cmake/check_headers.sh DIR KOKKOS     also the /kk styles; DIR must be a source tree, KOKKOS has the
#                                         headers of Kokkos
#   CXX=..., CXXFLAGS=...                 a compiler other than mpicxx, and further options for it
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
if [ $# = 0 ] || [ $# -gt 2 ]; then
  sed -n 's/^#   //p' "$0" >&2
  exit 2
fi
headers=$1
kokkos=${2:-}
if [ -f "$headers/src/lammps.h" ]; then headers=$headers/src; fi
if [ ! -f "$headers/lammps.h" ]; then
  echo "error: there is no lammps.h in $headers: give a LAMMPS source tree or its installed headers" >&2
  exit 2
fi

flags=(-std=c++17 -fsyntax-only -Wall -Wextra -Werror -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX -DLAMMPS_SMALLBIG
       -I"$top/src/BD-HYDRO" -I"$top/src/BD-HYDRO/core" -isystem "$headers")
sources=("$top"/src/BD-HYDRO/*.cpp)
if [ ! -f "$headers/fmt/format.h" ]; then flags+=(-DFMT_HEADER_ONLY); fi
# The date is in version.h of a source tree; installed headers lack this file.
if [ ! -f "$headers/version.h" ]; then
  flags+=(-isystem "$top/installed" -DBDH_LAMMPS_DATE="${BDH_LAMMPS_DATE:?the release of installed headers, such as 20250722}")
fi
if [ -n "$kokkos" ]; then
  flags+=(-DLMP_KOKKOS -I"$top/kokkos" -isystem "$headers/KOKKOS" -isystem "$kokkos")
  sources+=("$top"/kokkos/*.cpp)
fi

# shellcheck disable=SC2086
check() { ${CXX:-mpicxx} "${flags[@]}" ${CXXFLAGS:-} "$1"; }
failed=0
for source in "${sources[@]}"; do
  check "$source" || { echo "does not compile: ${source#"$top"/}"; failed=$((failed + 1)); }
done
echo "$headers: ${#sources[@]} files, $failed of them do not compile"
[ $failed = 0 ]
