#!/usr/bin/env bash
# Seconds per step of the plain styles on two processes and of the /kk styles on one and two threads, by turns.
#   bench/kokkos.sh LMP METHOD PARTICLES STEPS ROUNDS
set -euo pipefail
lmp=$1 method=$2 n=$3 steps=$4 rounds=${5:-3}
here=$(cd "$(dirname "$0")" && pwd)
export OMP_PROC_BIND=false
seconds() {    # of a step in the second run
  "$@" -in "$here/in.kokkos" -var method "$method" -var n "$n" -var steps "$steps" -log none -nocite |
    awk -v s="$steps" '/^Loop time/ { t = $4 } END { printf "%.5f", t / s }'
}
echo "$method, $n particles, $steps steps: s/step"
for ((i = 0; i < rounds; ++i)); do
  printf 'plain 1 rank %s   ' "$(seconds "$lmp")"
  printf 'plain 2 ranks %s   ' "$(seconds mpirun -np 2 "$lmp")"
  printf 'kk 1 thread %s   ' "$(seconds "$lmp" -k on t 1 -sf kk)"
  printf 'kk 2 threads %s\n' "$(seconds "$lmp" -k on t 2 -sf kk)"
done
