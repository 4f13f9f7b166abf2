#!/usr/bin/env bash
# Collapse of a 13-particle cluster with and without hydrodynamic interactions, compared with a reference.
#   TRAJECTORIES=96 DT=0.05 SCHEME=midpoint CELLS=32 TOLERANCE=1e-3 CORES=2 ./run.sh
#   KERNEL=roma3 H=3.27 ./run.sh     the grid of the paper's Table V, where the radius is 2.95 instead of 3.2
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
trajectories=${TRAJECTORIES:-96}

collapse() {    # name, number of trajectories, further variables
  local name=$1 n=$2 workers=$CORES    # one per core
  shift 2
  if [ "$workers" -gt "$n" ]; then workers=$n; fi
  rm -rf "results/$name"
  mkdir -p "results/$name"
  set -m
  farm "$workers" trajectories "$n" -in in.cluster -var out "results/$name" -var pictures yes "$@" &
  set +m
  watch_files $! "$n" "$name/rg.*" "$workers"
}

say "== $((2 * trajectories)) trajectories without hydrodynamic interactions, on $CORES cores"
collapse none $((2 * trajectories)) -var mobility none
say "== $trajectories trajectories with fix bd/fib, on $CORES cores"
collapse fib "$trajectories" -var mobility fib -var scheme "${SCHEME:-midpoint}" -var dt "${DT:-0.05}" \
  -var cells "${CELLS:-32}" -var kernel "${KERNEL:-peskin4}" -var h "${H:-2.5510204}"
say "== $((2 * trajectories)) trajectories with fix bd/pse, on $CORES cores"
collapse pse $((2 * trajectories)) -var mobility pse -var seed 5000 -var tolerance "${TOLERANCE:-1e-3}"
"$PYTHON" analyse.py "${KERNEL:-peskin4}"
