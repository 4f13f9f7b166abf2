#!/usr/bin/env bash
# Poiseuille flow in a square duct on four grids, and colloids carried by it.
#   STEPS=8000 ./run.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
for n in 8 16 32 64; do
  say "== profile, $n x $n cells"
  run_lmp -in in.profile -var n $n -var out results
done
say "== colloids"
run_lmp -in in.duct -var steps "${STEPS:-8000}" -var out results
"$PYTHON" analyse.py
