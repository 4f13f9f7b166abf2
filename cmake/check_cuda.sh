#!/usr/bin/env bash
# Compiles the device code of this package with nvcc, and checks that it calls no host functions.
# Prints the registers and spills of its kernels.  Needs no GPU; without nvcc it prints a message and
# succeeds.
#
#   cmake/check_cuda.sh        for sm_80
#   cmake/check_cuda.sh 90     for sm_80 and sm_90, in twice the time
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
build=${BDH_BUILD:-$top/build-cuda-check}
more=${1:-}

if ! command -v nvcc >/dev/null && [ ! -x "${CUDA_ROOT:-/usr/local/cuda}/bin/nvcc" ]; then
  echo "== CUDA: SKIPPED, device code not compiled: no nvcc in PATH or ${CUDA_ROOT:-/usr/local/cuda}/bin"
  exit 0
fi
BDH_KOKKOS=cuda BDH_BUILD=$build BDH_CMAKE_ARGS="-DBDH_CUDA_GENCODE=${more:+arch=compute_$more,code=sm_$more} ${BDH_CMAKE_ARGS:-}" \
  "$top/cmake/prepare.sh" build.ninja
ninja -C "$build" -t clean bdh_device_code >/dev/null    # messages appear only when compiling
log=$build/device_code.log
if ! ninja -C "$build" -k 0 bdh_device_code >"$log" 2>&1; then
  grep -E -A3 "error|FAILED" "$log" | cut -c1-400 | head -60
  echo "== CUDA: device code does not compile (full output of nvcc: $log)"
  exit 1
fi
python3 "$top/cmake/ptxas_summary.py" "$log"
echo "== CUDA: device code compiled for sm_80${more:+ and sm_$more} with $("$top"/build/kokkos/bin/nvcc_wrapper --version | grep -o 'release [0-9.]*' || true)"
