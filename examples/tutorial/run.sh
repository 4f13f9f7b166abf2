#!/usr/bin/env bash
# Runs the decks of the tutorial (doc/tutorial.md) one after the other and checks what they print.
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"

deck() {    # name of the log, deck, variables
  local name=$1 deck=$2
  shift 2
  run_lmp -in "$deck" "$@"
  mv results/lmp.log "results/$name.log"
  grep -E '^(side|D/D0|distance|height|pse:|fib:|none:) ?' "results/$name.log" | sed 's/^/  /'
}

say "== step 1: one sphere"
deck 1 in.1_sphere
deck 1.40 in.1_sphere -var side 40
say "== step 2: diffusion"
deck 2 in.2_diffusion
say "== step 3: two spheres"
deck 3 in.3_pair
deck 3.8 in.3_pair -var distance 8
say "== step 4: between two plates"
deck 4 in.4_wall
deck 4.open in.4_wall -var top open
say "== step 5: a suspension"
for mobility in pse fib none; do deck "5.$mobility" in.5_suspension -var mobility "$mobility"; done
say "== step 6: a gel"
for mobility in pse none; do deck "6.$mobility" in.6_gel -var mobility "$mobility"; done
"$PYTHON" check.py
