#!/usr/bin/env bash
# Repeats the figures and the table of the paper on positively split Ewald: bench/pse/*.csv, *.png.
# About 15 minutes on one idle core.  Arguments: names of the measurements to repeat; none: all.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${BENCH_PSE_PAPER:-build/bench/bench_pse_paper}
mkdir -p bench/pse
wanted=" $* "

measure() {    # name, arguments of the program
  local name=$1
  shift
  if [ "$wanted" != "  " ] && [[ "$wanted" != *" $name "* ]]; then return; fi
  echo "$name: $*"
  "$program" "$@" >"bench/pse/$name.csv.new" && mv "bench/pse/$name.csv.new" "bench/pse/$name.csv"
}

measure throughput throughput 10000 32000 100000 320000 1000000
measure splitting_phi0.1 splitting 100000 0.1
measure root root 1000 10000 100000
measure condition condition
measure tolerance tolerance
measure iterations iterations
measure splitting_phi0.02 splitting 100000 0.02
measure splitting_phi0.3 splitting 100000 0.3
# A gel, if one is given: three numbers a line (bench/README.md says how to make it), and as many hard spheres.
if [ -n "${GEL_POSITIONS:-}" ]; then
  measure splitting_gel splitting 0 0 "$GEL_POSITIONS" "${GEL_SIDE:?}"
  measure splitting_like_gel splitting "$(wc -l <"$GEL_POSITIONS")" "${GEL_PHI:?}"
fi
"${PYTHON:-/usr/bin/python3}" bench/plot_pse.py
