#!/usr/bin/env bash
# Copies this package into a LAMMPS source tree, so that LAMMPS' own CMake builds it like any other
# package, with -D PKG_BD-HYDRO=on.  See doc/install.md.
#
#   cmake/copy_to_lammps.sh /path/to/lammps             copies, or updates an earlier copy
#   cmake/copy_to_lammps.sh --remove /path/to/lammps    restores the tree
#
# A copy consists of
#   src/BD-HYDRO                              the styles, core/, kokkos/, and cmake/ with what both
#                                             builds share
#   cmake/Modules/Packages/BD-HYDRO.cmake     from BD-HYDRO.cmake.in
#   potentials/...                            the files of potentials/
#   cmake/CMakeLists.txt                      two more lines: one names the package, one includes its
#                                             module
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
name_line='  BD-HYDRO'
include_line='include(Packages/BD-HYDRO)'
# The lines of LAMMPS' CMakeLists.txt after which and before which those two belong.
name_after='set(STANDARD_PACKAGES'
include_before='GenerateStyleHeaders('

usage() { sed -n 's/^#   \(cmake\/copy_to_lammps\.sh .*\)/\1/p' "$0"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# count_lines TEXT: the number of lines of LAMMPS' CMakeLists.txt that begin with TEXT
count_lines() { awk -v text="$1" 'index($0, text) == 1 { n++ } END { print n + 0 }' "$list"; }

check_tree() {
  local file text
  [ -d "$lammps" ] || fail "there is no folder $lammps."
  for file in src/lammps.h src/version.h cmake/CMakeLists.txt cmake/Modules/StyleHeaderUtils.cmake; do
    [ -f "$lammps/$file" ] ||
      fail "$lammps is not a LAMMPS source tree: it has no $file.  Give the folder that contains src and cmake."
  done
  for text in "$name_after" "$include_before"; do
    [ "$(count_lines "$text")" = 1 ] ||
      fail "$list does not have exactly one line that begins with $text: this script does not know this version of LAMMPS."
  done
  if [ -e "$lammps/src/BD-HYDRO" ] && [ ! -f "$lammps/src/BD-HYDRO/fix_bd.h" ]; then
    fail "$lammps/src/BD-HYDRO exists but is not a copy of this package.  Move it away first."
  fi
}

# Lays the copy out in $stage, in the folders of a LAMMPS tree.
stage_copy() {
  local version room file
  version=$(sed -n 's/^project(bd_hydro VERSION \([0-9.]*\).*/\1/p' "$top/CMakeLists.txt")
  mkdir -p "$stage/src/BD-HYDRO/cmake" "$stage/cmake/Modules/Packages"
  for room in src/BD-HYDRO kokkos; do
    (cd "$top/$room" && find . -name '*.h' -o -name '*.cpp') | while read -r file; do
      local target=$stage/src/BD-HYDRO/$([ $room = kokkos ] && echo kokkos/)$file
      mkdir -p "$(dirname "$target")"
      cp "$top/$room/$file" "$target"
    done
  done
  if [ -f "$lammps/src/KOKKOS/fix_wall_harmonic_kokkos.h" ]; then    # newer versions have this style themselves
    rm -r "$stage"/src/BD-HYDRO/kokkos/backports
  fi
  cp "$top/cmake/bdh_core.cmake" "$top/cmake/bdh_package.cmake" "$stage/src/BD-HYDRO/cmake"
  sed "s/@BDH_VERSION@/$version/" "$top/cmake/BD-HYDRO.cmake.in" > "$stage/cmake/Modules/Packages/BD-HYDRO.cmake"
  cp -R "$top/potentials" "$stage"
}

# Replaces only files that differ, so that the next build compiles only these.
update_files() {
  local file changed=0
  while read -r file; do
    if ! cmp -s "$stage/$file" "$lammps/$file"; then
      mkdir -p "$(dirname "$lammps/$file")"
      rm -f "$lammps/$file"    # it may be a hard link
      cp "$stage/$file" "$lammps/$file"
      changed=$((changed + 1))
    fi
  done < <(cd "$stage" && find . -type f)
  while read -r file; do
    if [ ! -e "$stage/src/BD-HYDRO/$file" ]; then
      rm "$lammps/src/BD-HYDRO/$file"
      changed=$((changed + 1))
    fi
  done < <(cd "$lammps/src/BD-HYDRO" && find . -type f)
  find "$lammps/src/BD-HYDRO" -type d -empty -delete
  echo "src/BD-HYDRO, cmake/Modules/Packages/BD-HYDRO.cmake, potentials: $changed files changed"
}

remove_files() {
  local file
  if [ ! -e "$lammps/src/BD-HYDRO" ]; then
    echo "src/BD-HYDRO: nothing to remove"
    return
  fi
  rm -rf "$lammps/src/BD-HYDRO" "$lammps/cmake/Modules/Packages/BD-HYDRO.cmake"
  for file in "$top"/potentials/*; do
    rm -f "$lammps/potentials/$(basename "$file")"
  done
  echo "src/BD-HYDRO, cmake/Modules/Packages/BD-HYDRO.cmake, potentials: removed"
}

# rewrite_list INSERT: LAMMPS' CMakeLists.txt without our two lines, and with them again if INSERT is 1
rewrite_list() {
  awk -v name="$name_line" -v after="$name_after" -v include="$include_line" -v before="$include_before" -v insert="$1" '
    $0 == name || $0 == include { next }
    insert && index($0, before) == 1 { print include }
    { print }
    insert && index($0, after) == 1 { print name }' "$list" > "$stage/CMakeLists.txt"
  if cmp -s "$stage/CMakeLists.txt" "$list"; then
    echo "cmake/CMakeLists.txt: nothing to change"
    return
  fi
  echo "cmake/CMakeLists.txt, lines added (>) or removed (<):"
  diff "$list" "$stage/CMakeLists.txt" | grep '^[<>]' || true    # diff fails if there are differences
  cp -p "$list" "$list.new"    # with its permissions
  cat "$stage/CMakeLists.txt" > "$list.new"
  mv "$list.new" "$list"
}

action=copy
if [ "${1:-}" = --remove ]; then
  action=remove
  shift
fi
if [ $# != 1 ] || [ "${1#-}" != "$1" ]; then
  usage >&2
  exit 2
fi
lammps=${1%/}
list=$lammps/cmake/CMakeLists.txt
check_tree
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT

if [ $action = remove ]; then
  rewrite_list 0
  remove_files
else
  stage_copy
  update_files
  rewrite_list 1
  echo "Configure with:  cmake -S $lammps/cmake -B build-lmp -D PKG_BD-HYDRO=on -D CMAKE_BUILD_TYPE=Release"
fi
