#!/usr/bin/env bash
# Diffusion coefficient of free particles at large time steps: midpoint against trapezoidal.
#   BLOCKS=1500 ./run.sh              more blocks, smaller error bars
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
seed=0
for scheme in midpoint trapezoidal; do
  for beta in 0.1 0.36 0.72 1.43; do
    seed=$((seed + 1000))    # the noise depends on seed and step: with equal seeds the runs would be correlated
    name=${scheme}_${beta}
    say "== $scheme, beta = $beta"
    rm -rf "results/$name"
    mkdir -p "results/$name"
    run_lmp -in in.diffusion -var seed $seed -var scheme $scheme -var beta $beta -var blocks "${BLOCKS:-1500}" \
      -var out "results/$name"
  done
done
"$PYTHON" analyse.py
