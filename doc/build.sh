#!/usr/bin/env bash
# The manual as HTML, with Sphinx of Debian; every warning is an error, every internal link and the spelling are checked.
#   doc/build.sh [FOLDER]         FOLDER: build/doc by default; begin to read in FOLDER/html/doc/index.html
#   doc/build.sh --external       looks at links to other sites too, which needs the network
set -euo pipefail
cd "$(dirname "$0")/.."
out=build/doc
external=
if [ "${1:-}" = --external ]; then external=yes; elif [ -n "${1:-}" ]; then out=$1; fi
mkdir -p "$out"

# -E: read every page again, since warnings of pages that have not changed are not repeated
sphinx-build -q -E -W --keep-going -b html -d "$out/doctrees" -c doc . "$out/html"
python3 doc/check_pages.py "$out/html" build/lammps/doc/src
if [ -n "$external" ]; then sphinx-build -q -b linkcheck -d "$out/doctrees" -c doc . "$out/links"; fi
echo "manual: $out/html/doc/index.html"
