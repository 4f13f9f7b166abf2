#!/usr/bin/env bash
# Particles that are held: the drag on cubic lattices, and colloids that are driven past fixed posts.
#   STEPS=24000 SEED=12345 ./run.sh        length of the runs past posts, seed of their noise
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
for stresslet in no yes; do
  say "== drag on lattices that are held, stresslet $stresslet"
  mkdir "results/$stresslet"
  run_lmp -in in.drag -var stresslet $stresslet -var out "results/$stresslet"
done
for hydrodynamics in yes colloids no; do
  say "== colloids past fixed posts, hydrodynamics $hydrodynamics"
  run_lmp -in in.posts -var hydrodynamics $hydrodynamics -var steps "${STEPS:-24000}" -var seed "${SEED:-12345}" -var out results
done
"$PYTHON" analyse.py
