#!/usr/bin/env bash
# From a bare Debian 12 or 13 to a first result in a few minutes: installs packages, among them Debian's LAMMPS library,
# builds only this package (build-installed/lmp_bdh), simulates the collapse of a colloidal cluster, compares its radius of
# gyration with reference curves and draws a picture.  May be run again; finished parts are not repeated.
#
#   ./demo.sh          16 collapses
#   ./demo.sh --full   96, for smaller errors: 3 to 4 minutes more on 2 cores
#
# Debian's library lacks the KOKKOS package and some styles of LAMMPS.  For these, and for the tests, ./test.sh and
# cmake/prepare.sh build LAMMPS from source.
set -euo pipefail
cd "$(dirname "$0")"
case "${1:-}" in
  "") trajectories=16 cells=24 ;;
  --full) trajectories=96 cells=32 ;;
  *) sed -n 's/^#   \(.\/demo.sh.*\)/\1/p' "$0"; exit 1 ;;
esac
BDH_LAMMPS=installed cmake/prepare.sh lmp_bdh
TRAJECTORIES=${TRAJECTORIES:-$trajectories} CELLS=${CELLS:-$cells} LMP=build-installed/lmp_bdh examples/cluster/run.sh
printf '\nThe picture: %s\n' "$PWD/examples/cluster/results/cluster.png"
printf 'Next: read doc/tutorial.md, and set LMP=build-installed/lmp_bdh for the example scripts.\n'
