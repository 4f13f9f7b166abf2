#!/usr/bin/env bash
# Particles in harmonic traps in shear flow, one (2D) and two (3D), compared with linear theory.
#   SCALE=1 CORES=2 ./run.sh         SCALE multiplies the length of every run
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
scale=${SCALE:-1}
seed=0

trap_run() {    # deck, scheme, step/tau, total time/tau, steps between lines
  local name=$1_$2_$3 time
  seed=$((seed + 1000))    # the noise depends on seed and step: with equal seeds the runs would be correlated
  time=$("$PYTHON" -c "print($4 * $scale / $CORES)")
  say "== $name: $CORES x $time tau"
  rm -rf "results/$name"
  mkdir -p "results/$name"
  farm "$CORES" copies "$CORES" -in "in.shear.$1" -var scheme "$2" -var step "$3" -var time "$time" -var every "$5" \
    -var seed "$seed" -var out "results/$name"
}

for scheme in midpoint improved; do
  trap_run single $scheme 0.22 15000 1
  trap_run single $scheme 0.11 10000 1
  trap_run single $scheme 0.02 1500 5
done
trap_run pair midpoint 0.3 3000 1
trap_run pair midpoint 0.08 600 1
trap_run pair improved 0.3 3000 1
"$PYTHON" analyse.py
