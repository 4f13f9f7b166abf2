#!/usr/bin/env bash
# The sources must be formatted by clang-format 14 with .clang-format; other versions give other results.
#   unittest/check_format.sh         lists differences; exit status 77 (skipped) without clang-format 14
#   unittest/check_format.sh --fix   rewrites the files
set -euo pipefail
cd "$(dirname "$0")/.."
format=$(command -v clang-format-14 || command -v clang-format || true)
version=$([ -z "$format" ] || "$format" --version)
case $version in
  *"version 14."*) ;;
  *) echo "SKIPPED: requires clang-format 14, found ${version:-none}"; exit 77 ;;
esac
mode=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then mode=(-i); fi
find src kokkos unittest bench \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 "$format" --style=file "${mode[@]}"
