# Finds the LAMMPS source tree and builds it as a subproject, with the packages for the examples.

function(bdh_find_lammps out)
  set(candidates ${LAMMPS_SOURCE_DIR} ${LAMMPS_SOURCE_DIR}/.. ${CMAKE_SOURCE_DIR}/build/lammps)
  foreach(dir ${candidates})
    if(EXISTS ${dir}/cmake/CMakeLists.txt AND EXISTS ${dir}/src/lammps.h)
      get_filename_component(dir ${dir} REALPATH)
      set(${out} ${dir} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR
    "There is no LAMMPS source tree in any of: ${candidates}.  Run cmake/prepare.sh, which gets it "
    "from Debian, or set -DLAMMPS_SOURCE_DIR=/path/to/lammps.")
endfunction()

bdh_find_lammps(BDH_LAMMPS_DIR)
include(${CMAKE_CURRENT_LIST_DIR}/lammps_date.cmake)
bdh_lammps_date(BDH_LAMMPS_DATE ${BDH_LAMMPS_DIR}/src/version.h)
message(STATUS "LAMMPS source: ${BDH_LAMMPS_DIR} (version ${BDH_LAMMPS_DATE})")
if(BDH_LAMMPS_DATE LESS 20210929)
  message(FATAL_ERROR "BD-HYDRO needs LAMMPS 29 Sep 2021 or newer, but ${BDH_LAMMPS_DIR} is version "
    "${BDH_LAMMPS_DATE}: set -DLAMMPS_SOURCE_DIR to a newer source tree.")
endif()

# With Kokkos, only the packages that the examples and tests need, since /kk styles compile slowly.
set(BDH_LAMMPS_PACKAGES MOLECULE BROWNIAN RIGID ASPHERE DIPOLE)
if(NOT PKG_KOKKOS)
  list(APPEND BDH_LAMMPS_PACKAGES KSPACE COLLOID MISC EXTRA-PAIR EXTRA-FIX EXTRA-COMPUTE LATBOLTZ SRD MC
              REPLICA)
endif()
if(EXISTS ${BDH_LAMMPS_DIR}/src/GRAPHICS)    # has dump image since 2026
  list(APPEND BDH_LAMMPS_PACKAGES GRAPHICS)
endif()
option(BUILD_MPI "" ON)
if(NOT BUILD_MPI)
  list(REMOVE_ITEM BDH_LAMMPS_PACKAGES LATBOLTZ)    # needs MPI
endif()
foreach(pkg ${BDH_LAMMPS_PACKAGES})
  option(PKG_${pkg} "" ON)
endforeach()
option(WITH_PNG "" ON)
option(WITH_JPEG "" OFF)
option(LAMMPS_EXCEPTIONS "" ON)   # the tests drive LAMMPS as a library and read its error messages
set(BUILD_TOOLS OFF CACHE BOOL "")

# Registers our styles before LAMMPS writes its style headers.
include(${BDH_LAMMPS_DIR}/cmake/Modules/StyleHeaderUtils.cmake)
RegisterStyles(${BDH_SOURCE_DIR})
if(PKG_KOKKOS)
  RegisterStyles(${BDH_KOKKOS_DIR})
  # Newer releases have this style themselves.
  if(NOT EXISTS ${BDH_LAMMPS_DIR}/src/KOKKOS/fix_wall_harmonic_kokkos.h)
    set(BDH_BACKPORTS_DIR ${BDH_KOKKOS_DIR}/backports)
    RegisterStyles(${BDH_BACKPORTS_DIR})
  endif()
endif()

add_subdirectory(${BDH_LAMMPS_DIR}/cmake ${CMAKE_BINARY_DIR}/lammps-build)
if(BUILD_MPI)
  target_sources(lmp PRIVATE ${CMAKE_SOURCE_DIR}/cmake/flush_on_abort.cpp)
endif()
set_target_properties(lmp PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
