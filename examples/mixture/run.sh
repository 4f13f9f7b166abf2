#!/usr/bin/env bash
# Large and small spheres: depletion against molecular dynamics, velocities and self-diffusion against Ewald sums.
#   DURATION=20 SEED=1906 ./run.sh        time of the Brownian run, in units of viscosity a^3/kT, a: radius of a large one
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
seed=${SEED:-1906}
for name in pse newton alone; do mkdir -p results/$name; done
say "== structure by molecular dynamics, without the small spheres and with them"
run_lmp -in in.mixture -var small 0 -var dt 0.01 -var relax 40 -var duration 4000 -var seed "$seed" -var out results/alone
run_lmp -in in.mixture -var dt 0.002 -var relax 20 -var duration 160 -var seed "$seed" -var out results/newton
say "== Brownian dynamics with hydrodynamic interactions"
run_lmp -in in.mixture -var motion pse -var start results/newton/mixture.data -var duration "${DURATION:-20}" \
  -var seed "$seed" -var out results/pse
say "== velocities under given forces, and self-diffusion"
mobility() { run_lmp -in in.mobility -var spheres file -var data results/pse/mixture.data -var out results "$@"; }
for tolerance in 1e-2 1e-4 1e-6; do mobility -var tolerance $tolerance; done
mobility -var tolerance 1e-3 -var steps 2000
"$PYTHON" analyse.py
