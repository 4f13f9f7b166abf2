#!/usr/bin/env bash
# The message of an error on one rank reaches output and log file when neither is a terminal.
#   test_abort_message.sh LMP
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
cat >in.bad <<'EOF'
units lj
atom_style atomic
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
mass 1 1.0
variable big atom 1e308*10
fix push all addforce v_big 0 0
fix move all bd/fib 1.0 1.0 5 grid 8 8 8
run 1
EOF
"$1" -in in.bad -log log.bad >out.bad 2>&1
code=$?
status=0
[ "$code" -ne 0 ] || { echo "exit code 0"; status=1; }
for file in out.bad log.bad; do
  grep -q "atom 1 at step 1: the force on it is not a finite number" "$file" || { echo "no message in $file"; status=1; }
done
exit $status
