#!/usr/bin/env bash
# Installs the packages for the build, gets the LAMMPS source from Debian, configures and builds.  Each
# part first checks whether it is already done, so the script may be interrupted and run again.
#
#   cmake/prepare.sh [ninja targets...]      default target: lmp
#   BDH_LAMMPS=installed     uses Debian's LAMMPS library and builds only this package, in
#                            build-installed/: two minutes instead of ten, also on Debian 13
#   BDH_BUILD=dir        a build folder other than build/
#   BDH_CMAKE_ARGS=...   further arguments for cmake, such as -DLAMMPS_SOURCE_DIR=/path
#   BDH_KOKKOS=openmp    with Kokkos, also from Debian, in build-kokkos-openmp/, using the preset of that
#                        name.  Also serial or cuda (nvcc in the PATH, $CUDA_ROOT/bin or
#                        /usr/local/cuda/bin)
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
kokkos=${BDH_KOKKOS:-}
if [ "$kokkos" = 1 ]; then kokkos=openmp; fi
lammps=${BDH_LAMMPS:-source}
suffix=${kokkos:+-kokkos-$kokkos}
if [ "$lammps" = installed ]; then suffix=-installed; fi
build=${BDH_BUILD:-$top/build$suffix}
export DEBIAN_FRONTEND=noninteractive

# for lmp_bdh, and for the pictures of the examples
packages_installed=(ca-certificates cmake g++ libeigen3-dev libfftw3-dev libfmt-dev liblammps-dev librandom123-dev
  mpi-default-bin ninja-build pkg-config)
packages_pictures=(fonts-dejavu-core python3-matplotlib python3-numpy python3-pil)
# for everything
packages=(aspell aspell-en ca-certificates ccache chromium clang-format cmake codespell dpkg-dev fonts-dejavu-core g++ git
  libbenchmark-dev libeigen3-dev libfftw3-dev libgtest-dev libjs-katex libopenmpi-dev libpng-dev librandom123-dev ninja-build nlohmann-json3-dev
  openmpi-bin patch pkg-config python3-matplotlib python3-myst-parser python3-numpy python3-pil python3-pip python3-scipy python3-sphinx
  python3-sphinx-rtd-theme zlib1g-dev)

say() { printf '\n== %s\n' "$*"; }
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo DEBIAN_FRONTEND=noninteractive "$@"; fi; }

# install_packages PACKAGE...
install_packages() {
  local missing=() p
  for p in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || missing+=("$p")
  done
  if [ ${#missing[@]} -gt 0 ]; then
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    as_root dpkg --configure -a    # after an interrupted installation
    as_root apt-get update -q
    as_root apt-get install -y -q --no-install-recommends "${missing[@]}"
  fi
}

# LAMMPS comes as a Debian source package.  If apt has no source entry, this adds one in a separate
# file.
allow_source_packages() {
  if apt-get source --print-uris lammps >/dev/null 2>&1; then return; fi
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    awk '$2 == "bookworm" && $3 == "main" { print $1; exit }')
  say "adding source packages of ${mirror:=http://deb.debian.org/debian} to apt"
  as_root tee /etc/apt/sources.list.d/bd-hydro-source-packages.sources >/dev/null <<EOF
Types: deb-src
URIs: $mirror
Suites: bookworm
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
EOF
  as_root apt-get update -q
}

# from_debian PACKAGE SIZE: gets the files of a source package into build/PACKAGE.download
from_debian() {
  allow_source_packages
  say "getting the source of $1 ($2) from Debian"
  local work=$top/build/$1.download
  rm -rf "$work" && mkdir -p "$work"
  # When this runs as root, apt's sandbox user could not write there.
  (cd "$work" && apt-get source -q --download-only -o APT::Sandbox::User=root "$1/bookworm")
}

# Both of these functions move the tree last, so that a partly unpacked tree never has the final name.
get_lammps() {
  case " ${BDH_CMAKE_ARGS:-} " in *LAMMPS_SOURCE_DIR=*) return ;; esac
  if [ -e "$top/build/lammps/src/lammps.h" ]; then return; fi
  from_debian lammps "80 MB"
  local work=$top/build/lammps.download
  dpkg-source --no-check -x "$work"/lammps_*.dsc "$work/lammps"
  mv "$work/lammps" "$top/build/lammps"
  rm -rf "$work"
}

# Debian has no separate source package of Kokkos and removes it from that of LAMMPS.  Trilinos 13.2
# contains the same version.
get_kokkos() {
  case " ${BDH_CMAKE_ARGS:-} " in *EXTERNAL_KOKKOS=ON* | *BDH_KOKKOS_SOURCE_DIR=*) return ;; esac
  if [ -z "$kokkos" ] || [ -e "$top/build/kokkos/CMakeLists.txt" ]; then return; fi
  from_debian trilinos "166 MB, only Kokkos is kept"
  local work=$top/build/trilinos.download
  tar -C "$work" -xzf "$work"/trilinos_*.orig.tar.gz --wildcards '*/packages/kokkos/*'
  local p
  for p in "$top"/cmake/kokkos-patches/*.patch; do    # for CUDA 13
    patch -d "$work"/*/packages/kokkos -p1 -i "$p"
  done
  mv "$work"/*/packages/kokkos "$top/build/kokkos"
  rm -rf "$work"
}

# The pictures' packages are many small files, which one core installs while the others compile.
build_for_installed() {
  install_packages "${packages_installed[@]}"
  install_packages "${packages_pictures[@]}" >"$build/pictures.log" 2>&1 &
  local pictures=$!
  say "configuring and building in $build: $* (two minutes on 2 cores)"
  # shellcheck disable=SC2086
  cmake -S "$top" -B "$build" -G Ninja -DBDH_LAMMPS=installed ${BDH_CMAKE_ARGS:-}
  ninja -C "$build" "$@"
  wait "$pictures" || { cat "$build/pictures.log"; exit 1; }
}

build_targets() {
  say "configuring and building in $build: $* (LAMMPS alone takes 10 minutes the first time on 2 cores)"
  local preset=()
  [ -e "$build/CMakeCache.txt" ] || preset=(--preset "${kokkos:+kokkos-}${kokkos:-default}")
  # shellcheck disable=SC2086
  cmake -S "$top" -B "$build" "${preset[@]}" ${BDH_CMAKE_ARGS:-}
  ninja -C "$build" "$@"
}

mkdir -p "$build"
if [ "$lammps" = installed ]; then
  build_for_installed "${@:-lmp_bdh}"
  exit
fi
install_packages "${packages[@]}"
get_lammps
get_kokkos
build_targets "${@:-lmp}"
