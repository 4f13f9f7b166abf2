# The core is a separate library.  LAMMPS' headers are not on its include path, so it cannot depend
# on LAMMPS.  Also copied into LAMMPS trees by copy_to_lammps.sh.  BDH_SOURCE_DIR says where the sources
# are.
# In a build for one process, LAMMPS provides its stand-in for MPI as a target.
set(BDH_MPI mpi_stubs)
if(NOT TARGET mpi_stubs)
  find_package(MPI REQUIRED COMPONENTS CXX)
  set(BDH_MPI MPI::MPI_CXX)
endif()
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(PkgConfig REQUIRED)
pkg_check_modules(BDH_FFTW REQUIRED IMPORTED_TARGET fftw3 fftw3f)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)

set(BDH_CORE_DIR ${BDH_SOURCE_DIR}/core)
file(GLOB BDH_CORE_SOURCES CONFIGURE_DEPENDS ${BDH_CORE_DIR}/*/*.cpp)
# Ninja begins with those that come first.  These take longest to compile, and at the end one core would
# wait for them.
set(BDH_LONG_SOURCES pse/sphere_spread.cpp pse/window_spread.cpp pse/real_space.cpp fib/spread.cpp pse/mobility.cpp
    stokes/slit.cpp pse/wave_space.cpp stokes/periodic.cpp stokes/box.cpp pse/strain_pairs.cpp)
list(TRANSFORM BDH_LONG_SOURCES PREPEND ${BDH_CORE_DIR}/)
list(REMOVE_ITEM BDH_CORE_SOURCES ${BDH_LONG_SOURCES})
list(PREPEND BDH_CORE_SOURCES ${BDH_LONG_SOURCES})

add_library(bdh_core STATIC ${BDH_CORE_SOURCES})
# They have many sizes of kernels, written with vectors, which more optimisation makes no faster; it takes g++
# 34 s longer.
set_source_files_properties(${BDH_CORE_DIR}/pse/sphere_spread.cpp ${BDH_CORE_DIR}/pse/window_spread.cpp
  ${BDH_CORE_DIR}/fib/spread.cpp PROPERTIES COMPILE_OPTIONS $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-O2>)
target_include_directories(bdh_core PUBLIC ${BDH_CORE_DIR} ${RANDOM123_INCLUDE_DIR})
target_compile_features(bdh_core PUBLIC cxx_std_17)
# g++ 12 warns about uninitialised registers in its own AVX-512 intrinsics, which Eigen uses.
# Where there is no AVX-512, it notes that vectors of that length are passed differently since 4.6; ours
# are passed within one file only.
target_compile_options(bdh_core PRIVATE -Wall -Wextra -Wno-maybe-uninitialized -Wno-psabi ${BDH_HOST_ONLY})
# Without these, g++ does not vectorise loops with sqrt or floor, since they would set errno, or might trap.  LAMMPS
# itself can be built to trap.
target_compile_options(bdh_core PUBLIC -fno-math-errno PRIVATE -fno-trapping-math)
# The C++ bindings of MPI are no longer part of the standard, and their headers in Open MPI cause
# warnings.
target_compile_definitions(bdh_core PUBLIC OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
target_link_libraries(bdh_core PUBLIC PkgConfig::BDH_FFTW ${BDH_MPI})
target_link_libraries(bdh_core PRIVATE Eigen3::Eigen)
