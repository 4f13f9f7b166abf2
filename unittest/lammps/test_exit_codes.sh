#!/usr/bin/env bash
# Exit codes for a shell or a queue: 1 with the message in output and log for wrong input, on one rank
# and on two; 0 for correct input.
#   test_exit_codes.sh LMP [MPIEXEC]    without MPIEXEC, of a build without MPI, only on one rank
set -u
lmp=$1 mpiexec=${2:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
status=0

scene='units lj
atom_style atomic
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
mass 1 1.0'

expect() {    # ranks, exit code ("bad": any but 0), message, commands
  printf '%s\n%b\n' "$scene" "$4" >in.case
  rm -f log.case
  if [ "$1" = 1 ]; then
    "$lmp" -in in.case -log log.case >out.case 2>&1
  else
    "$mpiexec" --oversubscribe -np "$1" "$lmp" -in in.case -log log.case >out.case 2>&1
  fi
  local code=$?
  if [ "$2" = bad ]; then [ "$code" -ne 0 ]; else [ "$code" -eq "$2" ]; fi || { echo "exit code $code instead of $2: $4"; status=1; }
  local files='out.case log.case'
  # Other ranks than the first have no log file, and mpiexec may end the first one before LAMMPS has
  # written it.
  if [ "$1" != 1 ] && [ "$2" != 0 ]; then files=out.case; fi
  for file in $files; do
    grep -qF -- "$3" "$file" || { echo "'$3' is not in $file: $4"; status=1; }
  done
}

for ranks in 1 ${mpiexec:+2}; do
  expect $ranks 0 'Timing breakdown of fix 1 bd/fib' 'fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1'
  expect $ranks 0 'Timing breakdown of fix 1 bd/pse' 'fix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1'
  # errors on all ranks
  expect $ranks 1 'fix bd/fib: viscosity = 0, but must be > 0' 'fix 1 all bd/fib 1.0 0 5 grid 8 8 8'
  expect $ranks 1 'fix bd/pse: radius = -1, but must be > 0' 'fix 1 all bd/pse 1.0 1.0 5 radius -1'
  expect $ranks 1 'Pair style asakura/oosawa: c = -1' 'pair_style asakura/oosawa\npair_coeff * * -1 2'
  expect $ranks 1 'grid nz = 3, but kernel peskin4 needs' 'fix 1 all bd/fib 1.0 1.0 5 grid 8 8 3\nrun 1'
  expect $ranks 1 'are also integrated by fix 2 nve' 'fix 1 all bd/pse 1.0 1.0 5 radius 1\nfix 2 all nve\nrun 1'
  expect $ranks 1 'Lanczos has not converged' 'fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 1 tolerance 1e-9 iterations 2\nrun 1'
  # errors on one rank
  expect $ranks bad 'atom 2 at step 1: the force on it is not a finite number' \
    'variable big atom (id==2)*1e308*10\nfix 2 all addforce v_big 0 0\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1'
  expect $ranks bad 'in one step, which is more than half the box' 'fix 1 all bd/pse 1.0 1.0 5 radius 1\ntimestep 1e9\nrun 1'
done
if "$lmp" -h | grep -q asakura/oosawa/kk; then
  needs='a /kk style needs the KOKKOS package: start with -k on'
  expect 1 1 "pair_style asakura/oosawa/kk: $needs" 'pair_style asakura/oosawa/kk'
  # In newer releases this style is LAMMPS' own, and so is the message.
  if [ "${BDH_BACKPORTS:-0}" = 1 ]; then wall="fix wall/harmonic/kk: $needs"; else wall='KOKKOS styles without enabling KOKKOS'; fi
  expect 1 1 "$wall" 'change_box all boundary p p f\nfix 1 all wall/harmonic/kk zlo EDGE 1 1 1'
  expect 1 1 "fix bd/fib/kk: $needs" 'fix 1 all bd/fib/kk 1.0 1.0 5 grid 8 8 8'
  expect 1 1 "fix bd/pse/kk: $needs" 'fix 1 all bd/pse/kk 1.0 1.0 5 radius 1'
fi
# Replica exchange refuses the fix under its usual name, with a message and not a crash, and takes the other.
if [ -n "$mpiexec" ] && "$lmp" -h | grep -qw temper; then
  for style in bd/pse temp/bd/pse; do
    printf '%s\nfix 1 all %s 1.0 1.0 5 radius 1\ntemper 2 1 1.0 1 0 7\n' "$scene" $style >in.case
    "$mpiexec" --oversubscribe -np 2 "$lmp" -partition 2x1 -in in.case -log log.case >out.case 2>&1
    code=$?
    if [ $style = bd/pse ]; then
      [ $code -ne 0 ] && grep -q 'Tempering temperature fix is not supported' out.case
    else
      [ $code -eq 0 ]
    fi || { echo "exit code $code: temper with fix $style"; status=1; }
  done
fi
exit $status
