#!/usr/bin/env bash
# From a fresh Debian 12 to all tests passed.  Arguments go to ctest, as in ./test.sh -R pair
set -euo pipefail
cd "$(dirname "$0")"
cmake/prepare.sh all
ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
