#!/usr/bin/env bash
# Seconds per step of the plain styles on two processes and of the /kk styles on one and two threads, interleaved.
#   bench/kokkos.sh LMP METHOD PARTICLES STEPS ROUNDS
# At the end, the medians and the two ratios that matter: threads to processes, and two threads to one.
set -euo pipefail
lmp=$1 method=$2 n=$3 steps=$4 rounds=${5:-3}
here=$(cd "$(dirname "$0")" && pwd)
export OMP_PROC_BIND=false
seconds() {    # of a step in the second run
  "$@" -in "$here/in.kokkos" -var method "$method" -var n "$n" -var steps "$steps" -log none -nocite |
    awk -v s="$steps" '/^Loop time/ { t = $4 } END { printf "%.5f", t / s }'
}
median() { tr ' ' '\n' <<<"$*" | sort -n | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

echo "$method, $n particles, $steps steps: s/step"
plain=() ranks=() one=() two=()
for ((i = 0; i < rounds; ++i)); do
  plain+=("$(seconds "$lmp")")
  ranks+=("$(seconds mpirun -np 2 "$lmp")")
  one+=("$(seconds "$lmp" -k on t 1 -sf kk)")
  two+=("$(seconds "$lmp" -k on t 2 -sf kk)")
  echo "plain 1 rank ${plain[i]}   plain 2 ranks ${ranks[i]}   kk 1 thread ${one[i]}   kk 2 threads ${two[i]}"
done
awk -v p="$(median "${plain[@]}")" -v r="$(median "${ranks[@]}")" -v o="$(median "${one[@]}")" -v t="$(median "${two[@]}")" \
  'BEGIN { printf "medians: plain 1 rank %.5f, 2 ranks %.5f, kk 1 thread %.5f, 2 threads %.5f\n", p, r, o, t
           printf "time on 2 threads / on 2 ranks: %.2f; 2 threads %.2f times faster than 1\n", t / r, o / t }'
