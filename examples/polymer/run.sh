#!/usr/bin/env bash
# Diffusion of bead-spring chains with and without hydrodynamic interactions.
#   STEPS=30000 ./run.sh             length of the run with hydrodynamics; ten times as long without
#   CHAINS=6400 STEPS=2000 ./run.sh  102 400 beads
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
steps=${STEPS:-30000}
chains=${CHAINS:-32}
rm -rf results/*
mkdir -p results/none results/pse
say "== without hydrodynamic interactions: $((10 * steps)) steps"
run_lmp -in in.polymer -var mobility none -var chains "$chains" -var steps $((10 * steps)) -var out results/none
say "== fix bd/pse: $steps steps"
run_lmp -in in.polymer -var mobility pse -var chains "$chains" -var steps "$steps" -var seed 496 -var out results/pse
"$PYTHON" analyse.py
