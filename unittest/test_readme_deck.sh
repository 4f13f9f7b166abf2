#!/usr/bin/env bash
# test_readme_deck.sh LMP: the input script of README.md runs as it stands, but shorter, and prints the plan quoted there.
# So does its variant with fix bd/pse.
set -euo pipefail
lmp=$1
readme=$(dirname "$0")/../README.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# block WORD: the indented block of the section "An input script" that has WORD in it, without the indent
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

"$lmp" -in "$work/in.fib" -log "$work/log.fib" -screen none
block 'plan' | sed '/^ *$/d' >"$work/plan"
[ "$(wc -l <"$work/plan")" -ge 5 ]
while IFS= read -r line; do
  grep -qF -- "$line" "$work/log.fib" || { echo "README.md quotes, and the log has not: $line"; exit 1; }
done <"$work/plan"

"$lmp" -in "$work/in.pse" -log "$work/log.pse" -screen none
grep -q 'error of M F, random forces' "$work/log.pse"
