#!/usr/bin/env bash
# Microrollers over a plate: one roller, and strips whose front breaks up into fingers, at several heights and with several seeds.
#   HEIGHTS="1.5 2 3" SEEDS="1 2 3 4 5 6 7 8" ./run.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
rm -rf results/*
say "== one roller"
run_lmp -in in.single -var out results

strip() {    # height, seed; fingers grow in a time proportional to the height
  local out=results/$1_$2
  mkdir -p "$out"
  "$LMP" -log none -in in.rollers -var height "$1" -var duration "$(awk "BEGIN { print 1.6 * $1 }")" -var seed "$2" -var out "$out" >"$out/lmp.log" 2>&1 || { tail -n 15 "$out/lmp.log"; exit 1; }
  say "  height $1, seed $2"
}
export -f strip say
export LMP
say "== strips of 676 rollers"
for seed in ${SEEDS:-1 2 3 4 5 6 7 8}; do
  for height in ${HEIGHTS:-1.5 2 3}; do printf '%s %s\n' "$height" "$seed"; done
done | xargs -P "$CORES" -L 1 bash -c 'strip "$@"' _
"$PYTHON" analyse.py
