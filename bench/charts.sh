#!/usr/bin/env bash
# Measures and draws the charts of doc/charts: speed against accuracy, cost against size, where methods fail.
# About 20 minutes on an idle machine with 2 cores.  Arguments: names of the measurements to repeat; none: all.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BDH_BUILD:-build}
mkdir -p doc/charts
wanted=" $* "

measure() {    # name of the chart, command that prints its numbers
  local name=$1
  shift
  if [ "$wanted" != "  " ] && [[ "$wanted" != *" $name "* ]]; then return; fi
  echo "$name: $*"
  "$@" >"doc/charts/$name.csv.new" && mv "doc/charts/$name.csv.new" "doc/charts/$name.csv"
}

program=$build/bench/bench_charts
[ -x "$program" ] || { echo "build it first: ninja -C $build bench_charts bench_pse_sizes bench_schemes lmp" >&2; exit 1; }
measure accuracy "$program" accuracy
measure slit "$program" slit
measure spheres "$program" spheres
measure sphere_costs "$build/bench/bench_pse_sizes" 4000 0.1 1e-3 5
measure size "$program" size 100 320 1000 3200 10000 32000 100000 320000 1000000
measure split "$program" split
measure lanczos "$program" lanczos
measure delta "$program" delta
measure wall "$program" wall
measure open_wall "$program" open_wall
measure ranks "${PYTHON:-/usr/bin/python3}" bench/measure_ranks.py "$build/lmp" ${BDH_KOKKOS_LMP:-}    # with an lmp that has KOKKOS: threads too
measure collapse_time "${PYTHON:-/usr/bin/python3}" bench/measure_collapse.py "$build/lmp" "$build/bench/bench_schemes"
measure skipping "${PYTHON:-/usr/bin/python3}" bench/measure_skipping.py "$build/lmp"
"${PYTHON:-/usr/bin/python3}" bench/plot_charts.py
