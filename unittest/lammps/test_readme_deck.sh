#!/usr/bin/env bash
# test_readme_deck.sh LMP: the input script of README.md runs (for fewer steps) and prints the plan that
# README.md quotes.  So does its variant with fix bd/pse, whose plan doc/src/fix_bd_pse.rst quotes.
set -euo pipefail
lmp=$1
readme=$(dirname "$0")/../../README.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# block WORD: the indented block with WORD in the section "An input script", without the indent
block() {
  awk -v word="$1" '/^## An input script/ { on = 1; next }
    on && (/^    / || (/^$/ && text != "")) { text = text substr($0, 5) "\n"; next }
    on { if (index(text, word)) printf "%s", text; text = "" }
    /^## / { on = 0 }' "$readme"
}

block create_box | sed 's/^run .*/run 20/' >"$work/in.fib"
{ block create_box | sed '/^fix /,$d'; block 'bd/pse'; echo 'timestep 0.01'; echo 'run 20'; } >"$work/in.pse"
grep -q '^fix .*bd/fib' "$work/in.fib"
grep -q '^fix .*bd/pse' "$work/in.pse"

# quoted LOG PAGE: checks that each line of standard input is in the log
quoted() {
  sed '/^ *$/d' >"$work/plan"
  [ "$(wc -l <"$work/plan")" -ge 8 ] || { echo "no plan found in $2"; exit 1; }
  while IFS= read -r line; do
    grep -qF -- "$line" "$1" || { echo "$2 quotes, and the log has not: $line"; exit 1; }
  done <"$work/plan"
}

version=$(sed -n 's/^project(bd_hydro VERSION \([0-9.]*\).*/\1/p' "$(dirname "$0")/../../CMakeLists.txt")
"$lmp" -in "$work/in.fib" -log "$work/log.fib" -screen none
grep -qxF "fix bd/fib: plan (BD-HYDRO $version)" "$work/log.fib" || { echo "no version $version in the plan of fix bd/fib"; exit 1; }
block 'plan' | quoted "$work/log.fib" README.md

"$lmp" -in "$work/in.pse" -log "$work/log.pse" -screen none
grep -qxF "fix bd/pse: plan (BD-HYDRO $version)" "$work/log.pse" || { echo "no version $version in the plan of fix bd/pse"; exit 1; }
page=doc/src/fix_bd_pse.rst
sed -n '/^   fix bd\/pse: plan/,/^$/ s/^   //p' "$(dirname "$0")/../../$page" | quoted "$work/log.pse" $page
grep -q 'error of M F, random forces' "$work/log.pse"
