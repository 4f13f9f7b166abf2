#!/usr/bin/env bash
# Compiles the device code of this package with nvcc, and checks that it calls no host functions.
# Needs no GPU; without nvcc it prints a message and succeeds.
#
#   cmake/check_cuda.sh        for sm_80, with little optimization: some minutes
#   cmake/check_cuda.sh full   for sm_80 and sm_90 as in a build for use, and prints the registers and
#                              spills of the kernels: several times as long
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
build=${BDH_BUILD:-$top/build-cuda-check}

if ! command -v nvcc >/dev/null && [ ! -x "${CUDA_ROOT:-/usr/local/cuda}/bin/nvcc" ]; then
  echo "== CUDA: SKIPPED, device code not compiled: no nvcc in PATH or ${CUDA_ROOT:-/usr/local/cuda}/bin"
  exit 0
fi
mode=${1:-quick}
if [ "$mode" = full ]; then
  architectures="sm_80 and sm_90"
  args="-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DBDH_CUDA_GENCODE=arch=compute_90,code=sm_90"
elif [ "$mode" = quick ]; then
  architectures=sm_80
  args="-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DBDH_CUDA_GENCODE="
  export NVCC_APPEND_FLAGS="-Xcicc -O1 -Xptxas -O1"
else
  echo "check_cuda.sh: unknown argument $mode; use none or full"
  exit 1
fi
BDH_KOKKOS=cuda BDH_BUILD=$build BDH_CMAKE_ARGS="$args ${BDH_CMAKE_ARGS:-}" "$top/cmake/prepare.sh" build.ninja
if [ "$mode" = full ]; then ninja -C "$build" -t clean bdh_device_code >/dev/null; fi    # messages appear only when compiling
log=$build/device_code.log
if ! ninja -C "$build" -k 0 bdh_device_code >"$log" 2>&1; then
  grep -E -A3 "error|FAILED" "$log" | cut -c1-400 | head -60
  echo "== CUDA: device code does not compile (full output of nvcc: $log)"
  exit 1
fi
if [ "$mode" = full ]; then python3 "$top/cmake/ptxas_summary.py" "$log"; fi
echo "== CUDA: device code compiled for $architectures with $("$top"/build/kokkos/bin/nvcc_wrapper --version | grep -o 'release [0-9.]*' || true)"
