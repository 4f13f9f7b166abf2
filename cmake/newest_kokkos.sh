#!/usr/bin/env bash
# On Debian 13 as root: installs Kokkos of Debian's unstable release, builds with a LAMMPS tree that requires it, and runs the
# tests of the /kk styles, in build-newest-kokkos/.
#   cmake/newest_kokkos.sh DIR    LAMMPS source tree, 4 Jul 2026 or newer
set -euo pipefail
lammps=$1
cd "$(dirname "$0")/.."
export DEBIAN_FRONTEND=noninteractive
packages=(ca-certificates ccache cmake g++ git libeigen3-dev libfftw3-dev libgtest-dev libopenmpi-dev libpng-dev librandom123-dev
  ninja-build nlohmann-json3-dev openmpi-bin patch pkg-config python3-numpy zlib1g-dev)

mirror=$(apt-get indextargets --format '$(REPO_URI) $(COMPONENT)' 'Created-By: Packages' | awk '$2 == "main" { print $1; exit }')
echo "deb [check-valid-until=no] $mirror unstable main" >/etc/apt/sources.list.d/unstable.list
printf 'Package: *\nPin: release a=unstable\nPin-Priority: 100\n' >/etc/apt/preferences.d/unstable    # nothing else from there
apt-get update -q
apt-get install -y -q --no-install-recommends "${packages[@]}" libkokkos-dev

# The package names two libraries that it lacks; they hold nothing.
folder=$(dirname "$(dpkg -L libkokkos-dev | grep 'libkokkoscore.so$')")
for name in $(grep -ho 'libkokkos[a-z]*\.a' "$folder"/cmake/Kokkos/*.cmake | sort -u); do
  [ -e "$folder/$name" ] || ar cr "$folder/$name"
done

cmake --preset kokkos-serial -B build-newest-kokkos -DCMAKE_CXX_STANDARD=20 -DEXTERNAL_KOKKOS=ON -DBUILD_OMP=ON \
  -DLAMMPS_SOURCE_DIR="$lammps" -DBDH_BENCHMARKS=OFF
ninja -C build-newest-kokkos lmp bdh_kokkos_tests
ctest --test-dir build-newest-kokkos -L kokkos -j "$(nproc)"
