#!/usr/bin/env bash
# cmake/copy_to_lammps.sh on a copy of the relevant parts of a LAMMPS tree: what it refuses, that LAMMPS'
# own CMake finds the styles and compiles one, that a second run updates, and that --remove restores
# every byte.
#   unittest/check_lammps_tree.sh LAMMPS WORK [KOKKOS]
#     LAMMPS  a source tree, which stays as it is
#     WORK    a folder to work in, which is made again
#     KOKKOS  a source tree of Kokkos; without it the /kk styles are not looked for
set -euo pipefail
lammps=$1 work=$2 kokkos=${3:-}
copy() { "$(dirname "$0")/../cmake/copy_to_lammps.sh" "$@"; }
tree=$work/lammps
log=$work/log
failures=0
wrong() { printf 'FAILED: %s\n' "$*"; failures=$((failures + 1)); }

# expect TEXT COMMAND...: the command succeeds and its output contains TEXT
expect() {
  local text=$1
  shift
  "$@" > "$log" 2>&1 || { cat "$log"; wrong "'$*' does not succeed"; }
  grep -qF -- "$text" "$log" || { cat "$log"; wrong "'$*' does not say: $text"; }
}

# expect_refusal TEXT COMMAND...: the command fails and its output contains TEXT
expect_refusal() {
  local text=$1
  shift
  if "$@" > "$log" 2>&1; then wrong "'$*' should fail"; fi
  tr -s ' \n' ' ' < "$log" | grep -qF -- "$text" || { cat "$log"; wrong "'$*' does not say: $text"; }
}

# expect_original: cmake/, src/ and potentials/ are those of LAMMPS
expect_original() {
  local folder
  for folder in cmake src potentials; do
    diff -r "$lammps/$folder" "$tree/$folder" || wrong "$folder differs from the original $1"
  done
}

configure() { cmake -S "$tree/cmake" -B "$work/build" -G Ninja "$@"; }

# expect_styles NAME...: the style headers of the build name these headers of this package, each once
expect_styles() {
  local found
  found=$(cat "$work"/build/styles/style_{fix,pair}.h | grep -oE '(fix_bd|pair_asakura)[a-z_]+' | tr '\n' ' ' || true)
  [ "$found" = "${*:+$* }" ] || wrong "style_fix.h and style_pair.h name '$found', not '$*'"
}

rm -rf "$work"
mkdir -p "$tree"
cp -R "$lammps/cmake" "$lammps/src" "$lammps/potentials" "$tree"
if [ -n "$kokkos" ]; then
  mkdir "$tree/lib"
  ln -s "$kokkos" "$tree/lib/kokkos"
fi

# What it refuses, without a change.
expect_refusal "there is no folder $work/nowhere" copy "$work/nowhere"
expect_refusal "is not a LAMMPS source tree: it has no src/lammps.h" copy "$work"
mkdir "$tree/src/BD-HYDRO"
expect_refusal "is not a copy of this package" copy "$tree"
expect_refusal "is not a copy of this package" copy --remove "$tree"
rmdir "$tree/src/BD-HYDRO"
sed -i 's/^GenerateStyleHeaders/#&/' "$tree/cmake/CMakeLists.txt"
expect_refusal "does not know this version of LAMMPS" copy "$tree"
sed -i 's/^#GenerateStyleHeaders/GenerateStyleHeaders/' "$tree/cmake/CMakeLists.txt"
expect_original "after refusals"

# A copy, a second one that changes nothing, and an update that repairs.
expect "include(Packages/BD-HYDRO)" copy "$tree"
expect ": 0 files changed" copy "$tree"
expect "cmake/CMakeLists.txt: nothing to change" copy "$tree"
cp -R "$tree" "$work/first"
echo "// changed" >> "$tree/src/BD-HYDRO/core/base/comm.cpp"
mkdir "$tree/src/BD-HYDRO/core/old_room"
touch "$tree/src/BD-HYDRO/core/old_room/old.cpp"
expect ": 2 files changed" copy "$tree"
diff -r "$work/first" "$tree" || wrong "an update differs from a first copy"
rm -rf "$work/first"

# LAMMPS' own CMake.
configure -D PKG_BD-HYDRO=off > "$log" 2>&1 || { cat "$log"; wrong "LAMMPS without the package does not configure"; }
expect_styles
expect "Enabled packages: BD-HYDRO" configure -D PKG_BD-HYDRO=on -D BUILD_MPI=off
expect "fix_bd_pse.cpp.o" ninja -C "$work/build" "$tree/src/BD-HYDRO/fix_bd_pse.cpp^"
expect "Enabled packages: BD-HYDRO" configure -D PKG_BD-HYDRO=on -D BUILD_MPI=on
expect_styles fix_bd_fib fix_bd_pse pair_asakura_oosawa
expect "fix_bd_pse.cpp.o" ninja -C "$work/build" "$tree/src/BD-HYDRO/fix_bd_pse.cpp^"
expect "bdh_lammps.cpp.o" ninja -C "$work/build" "$tree/src/BD-HYDRO/bdh_lammps.cpp^"
if [ -n "$kokkos" ]; then
  expect "Enabled packages: BD-HYDRO;KOKKOS" configure -D PKG_KOKKOS=on
  expect_styles fix_bd_fib fix_bd_fib_kokkos fix_bd_pse fix_bd_pse_kokkos pair_asakura_oosawa pair_asakura_oosawa_kokkos
fi

expect "removed" copy --remove "$tree"
expect_original "after --remove"
expect "nothing to remove" copy --remove "$tree"

[ $failures = 0 ] || { echo "$failures checks failed"; exit 1; }
rm -rf "$work"
echo "all checks passed"
