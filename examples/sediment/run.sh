#!/usr/bin/env bash
# Colloids above one plate under fluid without end: mobilities of one and two spheres, heights and diffusion of many.
#   BLOCKS=25 SEED=11 ./run.sh        number of independent averages, seed of the particles
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -f results/*.dat
say "== mobility of one sphere and of two"
run_lmp -in in.mobility -var out results
say "== colloids of finite weight"
run_lmp -in in.sediment -var blocks "${BLOCKS:-25}" -var seed "${SEED:-11}" -var out results
"$PYTHON" analyse.py
