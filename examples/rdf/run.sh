#!/usr/bin/env bash
# g(r), energy and pressure of a dilute and a dense suspension against Monte Carlo, at large and smaller time steps.
#   SCALE=1 ./run.sh                 multiplies the length of every run
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
scale=${SCALE:-1}

suspension() {    # N, scheme, dt, steps
  local name=N$1_$2_dt$3 steps
  steps=$("$PYTHON" -c "print(200 * round($4 * $scale / 200))")
  say "== $name: $steps steps"
  mkdir -p "results/$name"
  run_lmp -in in.rdf -var N "$1" -var scheme "$2" -var dt "$3" -var steps "$steps" -var out "results/$name"
}

rm -rf results/N*
suspension 1000 improved 50 12000
suspension 1000 midpoint 100 6000
suspension 1000 midpoint 50 6000
suspension 3300 improved 25 4000
suspension 3300 midpoint 50 3000
suspension 3300 midpoint 25 3000
"$PYTHON" analyse.py
