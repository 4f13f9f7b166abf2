#!/usr/bin/env bash
# Colloids in Poiseuille flow, without and with repulsion.
#   STEPS=20000 ./run.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
for kind in free wca; do
  say "== $kind"
  mkdir -p "results/$kind"
  run_lmp -in in.channel-flow -var repulsion "$([ $kind = free ] && echo 0.0 || echo 1.0)" \
    -var steps "${STEPS:-20000}" -var out "results/$kind"
done
"$PYTHON" analyse.py
