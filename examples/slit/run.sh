#!/usr/bin/env bash
# Distribution of the distance to a wall: midpoint and Euler-Maruyama.
#   BLOCKS=40 SEED=11 ./run.sh        number of independent averages, seed of the particles
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
say "== mobility across the slit of Fig. 1"
rm -f results/mobility.dat
run_lmp -in in.mobility -var out results
run_scheme() {    # scheme, particles, time step, time of a block
  say "== $1"
  mkdir -p "results/$1"
  run_lmp -in in.slit -var scheme "$1" -var particles "$2" -var dt "$3" -var time "$4" -var blocks "${BLOCKS:-40}" \
    -var seed "${SEED:-11}" -var out "results/$1"
}
run_scheme midpoint 100 0.025 500
run_scheme euler 1 0.05 5000      # the biased law is known for one particle
"$PYTHON" analyse.py
