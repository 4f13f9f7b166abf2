# Sourced by the run.sh of every example: finds lmp and a Python with numpy, counts the cores, creates results/.
#   LMP=file  PYTHON=file  CORES=n     override what is found here
set -euo pipefail
LMP=${LMP:+$(realpath "$LMP")}    # relative to where the user is
cd "$(dirname "${BASH_SOURCE[1]}")"
LMP=${LMP:-$(realpath ../../build/lmp)}
[ -x "$LMP" ] || { echo "no executable $LMP: build it with cmake/prepare.sh, or set LMP=file"; exit 1; }
if [ -z "${PYTHON:-}" ]; then
  PYTHON=python3
  "$PYTHON" -c 'import numpy' 2>/dev/null || PYTHON=/usr/bin/python3
fi
CORES=${CORES:-$(nproc)}
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# A run without mpirun needs no daemon, which Open MPI 4 would start and which takes 5 s where the host has no known name.
export OMPI_MCA_ess_singleton_isolated=1
mkdir -p results

say() { printf '%s\n' "$*"; }

# run_lmp ARGS...: one run; its output goes to results/lmp.log, the end of which is shown if it fails.
run_lmp() {
  "$LMP" -log none "$@" >results/lmp.log 2>&1 || { tail -n 15 results/lmp.log; exit 1; }
}

# farm PROCESSES NAME TOTAL ARGS...: independent runs 1 to TOTAL, shared among processes.  Each gets the variables first and
# NAME, its first and last run.
farm() {
  local n=$1 name=$2 total=$3 k pids=() failed= log
  shift 3
  rm -f results/lmp.*.log
  if [ "$n" -gt "$total" ]; then n=$total; fi
  for ((k = 0; k < n; ++k)); do
    "$LMP" -log none -var first $((k * total / n + 1)) -var "$name" $(((k + 1) * total / n)) "$@" >"results/lmp.$k.log" 2>&1 &
    pids+=($!)
  done
  trap "kill ${pids[*]} 2>/dev/null || true" EXIT    # also after Ctrl-C
  for ((k = 0; k < n; ++k)); do
    if ! wait -n; then failed=1; break; fi
  done
  if [ -n "$failed" ]; then
    log=$(grep -l ERROR results/lmp.*.log | head -n 1) || true
    tail -n 15 "${log:-results/lmp.0.log}"
    exit 1
  fi
  trap - EXIT
}

# watch_files PID TOTAL PATTERN WORKERS: reports every few seconds how many of TOTAL runs have finished, until PID ends.
# PID must lead its own process group (set -m).  Each run opens its file when it begins, so up to WORKERS of the files found
# belong to runs that have not finished.
watch_files() {
  local pid=$1 total=$2 pattern=$3 workers=$4 start=$SECONDS last=-1 finished
  trap "kill -- -$pid 2>/dev/null || true" EXIT        # the whole process group
  while kill -0 "$pid" 2>/dev/null; do
    finished=$(($(find results -path "results/$pattern" | wc -l) - workers))
    if [ "$finished" -gt "$last" ]; then
      say "  $((finished > 0 ? finished : 0)) of $total done, $((SECONDS - start)) s"
      last=$finished
    fi
    for _ in {1..50}; do
      if kill -0 "$pid" 2>/dev/null; then sleep 0.2; fi
    done
  done
  wait "$pid" || exit 1
  trap - EXIT
  say "  all $total done in $((SECONDS - start)) s"
}
