#!/usr/bin/env bash
# Hard-sphere-like suspensions: velocities against a dense matrix at many tolerances, then diffusion.
#   STEPS=10000 ./run.sh             length of the diffusion runs
#   REPLICATE=6 STEPS=1000 ./run.sh  108 000 colloids
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
for phi in 0.1 0.3; do
  say "== phi = $phi: velocities under given forces, nine tolerances"
  for tolerance in 1e-1 1e-2 1e-3 1e-4 1e-5 1e-6 1e-7 1e-8 1e-9; do
    name=mobility_phi${phi}_$tolerance
    mkdir -p "results/$name"
    run_lmp -in in.mobility -var phi $phi -var tolerance $tolerance -var out "results/$name"
  done
done
seed=4711
for phi in 0.1 0.3; do
  for mobility in pse none; do
    seed=$((seed + 1000))    # the noise depends on seed and step
    name=path_phi${phi}_$mobility
    mkdir -p "results/$name"
    say "== phi = $phi, mobility $mobility: diffusion"
    run_lmp -in in.suspension -var phi $phi -var mobility $mobility -var seed $seed -var steps "${STEPS:-10000}" \
      -var replicate "${REPLICATE:-1}" -var out "results/$name"
  done
done
"$PYTHON" analyse.py
