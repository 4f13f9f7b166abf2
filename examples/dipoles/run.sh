#!/usr/bin/env bash
# A ferrofluid in a field: molecular dynamics, then Brownian dynamics with and without hydrodynamic interactions.
#   DURATION=400 SEED=1779 ./run.sh       time of the Brownian runs, in units of viscosity a^3/kT
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
seed=${SEED:-1779}
for motion in newton none pse; do
  mkdir -p results/$motion
  say "== motion $motion"
  duration=${DURATION:-400} dt=0.02 number=$seed
  if [ $motion = newton ]; then duration=2000 dt=0.01; fi
  if [ $motion = pse ]; then number=$((seed + 1)) dt=0.04; fi    # near steps of 0.02
  run_lmp -in in.dipoles -var motion $motion -var dt $dt -var duration "$duration" -var seed "$number" \
    -var start results/newton/start.data -var out results/$motion
done
"$PYTHON" analyse.py
