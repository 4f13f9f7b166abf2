#!/usr/bin/env bash
# What to run on a machine with a GPU: builds everything, tests all formulas and styles on the GPU, and measures whole steps of both
# fixes beside the bounds of bench/gpu_estimate.py.
#   bench/gpu.sh [GPUS [SIDE...]]      SIDE^3 particles; default: one GPU, 10^4, 10^5 and 10^6 particles
#   BDH_KOKKOS=openmp bench/gpu.sh 2 10     the same with processes of the host in the place of GPUs, to try it out
set -euo pipefail
cd "$(dirname "$0")/.."
gpus=${1:-1}
shift || true
sides=("$@")
[ $# -gt 0 ] || sides=(22 46 100)
kokkos=${BDH_KOKKOS:-cuda}
build=build-kokkos-$kokkos
options="-k on g $gpus -sf kk"
[ "$kokkos" = cuda ] || options="-k on t 1 -sf kk/device"

BDH_KOKKOS=$kokkos cmake/prepare.sh lmp bdh_kokkos_tests
"$build/unittest/test_device_kernels"
failed=0
ctest --test-dir "$build" -L kokkos --output-on-failure || failed=1
for ((n = 1; n <= gpus; n = n < gpus && 2 * n > gpus ? gpus : 2 * n)); do
  bench/gpu_estimate.py "$build/lmp" --side "${sides[@]}" --ranks "$n" --measure "${options/g $gpus/g $n}"
done
[ "$failed" = 0 ] || { echo "some tests failed: see above"; exit 1; }
