# Options that a user may set with -D.  LAMMPS' own options (PKG_..., BUILD_MPI, ...) work as usual.
set(BDH_LAMMPS source CACHE STRING "source: build LAMMPS, too; installed: use an installed LAMMPS library")
set(LAMMPS_SOURCE_DIR "" CACHE PATH
    "An existing LAMMPS source tree (its top or src folder); empty: build/lammps, from cmake/prepare.sh")
option(BDH_NATIVE "Compile for the processor of this machine (-march=native)" ON)
option(BDH_TESTS "Build the tests (needs libgtest-dev)" ON)
option(BDH_LAMMPS_UNITTEST "Run this package's styles in LAMMPS' own test drivers (needs libyaml-dev, libgmock-dev)" OFF)
option(BDH_BENCHMARKS "Build the kernel benchmarks (needs libbenchmark-dev)" ON)
option(BDH_PRECOMPILED_HEADERS "Precompiled headers for the sources of LAMMPS, for a faster first build" OFF)
set(BDH_SANITIZE OFF CACHE STRING "Sanitizers for the package and its tests.  ON: address and undefined behaviour; thread: threads")

if(BDH_NATIVE)
  add_compile_options(-march=native)
endif()
if(SKBUILD)    # messages name source files, which in a wheel must not contain the folder that it was built in
  add_compile_options(-ffile-prefix-map=${CMAKE_SOURCE_DIR}/=)
endif()
if(BDH_SANITIZE STREQUAL "thread")
  add_compile_options(-fsanitize=thread -g)
  add_link_options(-fsanitize=thread)
elseif(BDH_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

find_program(BDH_CCACHE ccache)
if(BDH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${BDH_CCACHE})
endif()
