#!/usr/bin/env bash
# A gel of colloids with a depletion attraction, with and without hydrodynamic interactions, both runs at once.
#   N=2000 DURATION=10 RANKS=1 ./run.sh        DURATION in units of 6 pi viscosity a^3/kT; RANKS: processes per run
#   N=110000 DURATION=3 RANKS=8 ./run.sh       the large one
source "$(dirname "${BASH_SOURCE[0]}")/../common/run_common.sh"
ranks=${RANKS:-1}
run=("$LMP")
if [ "$ranks" -gt 1 ]; then run=(mpirun --oversubscribe --bind-to none -np "$ranks" "$LMP"); fi

gel() {    # mobility
  rm -rf "results/$1"
  mkdir -p "results/$1"
  "${run[@]}" -in in.gel -log none -var mobility "$1" -var N "${N:-2000}" -var duration "${DURATION:-10}" \
    -var out "results/$1" >"results/$1/lmp.log" 2>&1
}

set -m
say "== ${N:-2000} colloids, with fix bd/pse and without hydrodynamic interactions, processes per run: $ranks"
gel none &
none=$!
gel pse &
pse=$!
trap 'kill -- -$none -$pse 2>/dev/null || true' EXIT
last=
while kill -0 "$none" 2>/dev/null || kill -0 "$pse" 2>/dev/null; do
  sleep 1
  [ $((SECONDS % 10)) -eq 0 ] || continue
  now=
  for name in none pse; do
    step=$(awk 'NF == 3 && $1 ~ /^[0-9]+$/ { s = $1 } END { print s + 0 }' "results/$name/lmp.log")
    now="$now  $name: step $step"
  done
  if [ "$now" != "$last" ]; then say "$now, $SECONDS s"; fi
  last=$now
done
for name in none pse; do
  wait "${!name}" || { tail -n 15 "results/$name/lmp.log"; exit 1; }
done
trap - EXIT
set +m
"$PYTHON" analyse.py
