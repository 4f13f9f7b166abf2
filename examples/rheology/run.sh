#!/usr/bin/env bash
# Rigid spheres in shear: viscosity of hard spheres against packing fraction and from fluctuations, shear thinning of a Brownian suspension.
#   STEPS=8000 ./run.sh             length of the runs in steady shear at Peclet numbers of 10 and more
#   SEED=12345 ./run.sh             seed of their noise
#   MODULI=yes ./run.sh             moduli of dumbbells too, three more minutes
#   YIELD=yes ./run.sh              gels that yield too, six more minutes
#   GELS=6                          number of gels
#   CONFIGURATIONS=6 ./run.sh       number of configurations of hard spheres at each packing fraction
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
for phi in 0.05 0.1 0.15 0.2 0.25 0.3; do
  say "== hard spheres at phi = $phi: viscosity at temperature 0"
  mkdir -p "results/$phi"
  "$PYTHON" hard_spheres.py 4 $phi "${CONFIGURATIONS:-6}" 1 "results/$phi"
  for data in "results/$phi"/data.*; do
    run_lmp -in in.viscosity -var data "$data" -var phi $phi -var out results
  done
done
say "== one configuration at phi = 0.4: viscosity from a step in shear, and from the noise of the stress"
mkdir -p results/0.4
run_lmp -in in.viscosity -var out results/0.4
run_lmp -in in.fluctuations -var out results/0.4
run_lmp -in in.walls -var out results/0.4
steps=${STEPS:-8000}
seed=${SEED:-12345}                   # the noise depends on seed and step
for case in "1 3" "3 2" "10 1" "30 1" "100 1"; do
  set -- $case                        # Peclet number, multiple of STEPS
  say "== steady shear at Peclet number $1, with and without stresslets"
  run_lmp -in in.shear -var peclet $1 -var steps $((steps * $2)) -var seed $((seed + $1)) -var out results
  run_lmp -in in.shear -var peclet $1 -var steps $((4 * steps * $2)) -var seed $((seed + 1000 + $1)) -var stresslet no \
    -var out results
done
if [ -n "${MODULI:-}" ]; then
  say "== dumbbells: fluctuations of the stress at rest, and small oscillations"
  for case in "0 200 201" "0.5 200 202" "1.5 100 203" "5 100 204"; do
    set -- $case                      # frequency, duration of a block, added to the seed
    run_lmp -in in.moduli -var omega $1 -var time $2 -var seed $((seed + $3)) -var out results
  done
fi
if [ -n "${YIELD:-}" ]; then
  for ((gel = 1; gel <= ${GELS:-6}; ++gel)); do
    say "== gel $gel forms, and is sheared forth and back at three rates"
    folder=results/yield/$gel
    mkdir -p "$folder"
    yields() { run_lmp -in in.yield -var seed $((seed + 1000 * gel)) -var out "$folder" -var start "$folder/gel.data" "$@"; }
    yields -var peclet 10 -var pictures $((gel == 1 ? 5 : 0))
    for peclet in -10 1 -1 30 -30; do yields -var peclet $peclet -var make no; done
  done
fi
"$PYTHON" analyse.py
if [ -n "${YIELD:-}" ]; then "$PYTHON" analyse_yield.py; fi
