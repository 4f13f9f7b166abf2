#!/usr/bin/env bash
# Distribution of free particles inside a grid cell: Euler-Maruyama against midpoint.
#   SAMPLES=4000 ./run.sh            number of configurations of 3000 particles per scheme
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
say "== mobility at 144 positions in a cell"
run_lmp -in in.mobility -var out results
for scheme in euler midpoint; do
  say "== $scheme"
  rm -rf "results/$scheme"
  mkdir -p "results/$scheme"
  run_lmp -in in.cell -var scheme $scheme -var samples "${SAMPLES:-4000}" -var out "results/$scheme"
done
"$PYTHON" analyse.py
