#!/usr/bin/env bash
# Distribution of the distance to a wall: midpoint and Euler-Maruyama.
#   SAMPLES=20000 ./run.sh            configurations per scheme
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
say "== mobility across the slit of Fig. 1"
rm -f results/mobility.dat
run_lmp -in in.mobility -var out results
run_scheme() {    # scheme, particles, samples
  say "== $1"
  mkdir -p "results/$1"
  run_lmp -in in.slit -var scheme "$1" -var particles "$2" -var samples "$3" -var out "results/$1"
}
samples=${SAMPLES:-20000}
run_scheme midpoint 100 "$samples"
run_scheme euler 1 $((20 * samples))      # the biased law is known for one particle
"$PYTHON" analyse.py
