# Kokkos for LAMMPS' KOKKOS package and for kokkos/ of this package, if -DPKG_KOKKOS=ON is set.
#
#   default                                   Kokkos 3.4.01, the version of LAMMPS 29 Sep 2021, built
#                                             here from source; cmake/prepare.sh gets it from
#                                             Debian's package trilinos
#   -DEXTERNAL_KOKKOS=ON -DKokkos_ROOT=dir    an installed Kokkos, 3.4 or newer as LAMMPS requires;
#                                             without Kokkos_ROOT that of Debian's
#                                             libtrilinos-kokkos-dev, which has only the Serial
#                                             backend
#
# Kokkos_ENABLE_OPENMP, Kokkos_ENABLE_CUDA and Kokkos_ARCH_... choose the backends, as in any build
# of Kokkos.
option(PKG_KOKKOS "LAMMPS' KOKKOS package and the /kk styles of this one" OFF)
option(EXTERNAL_KOKKOS "Use an installed Kokkos" OFF)
set(BDH_KOKKOS_SOURCE_DIR ${CMAKE_SOURCE_DIR}/build/kokkos CACHE PATH "Source of Kokkos 3.4.01, put there by cmake/prepare.sh")
if(NOT PKG_KOKKOS)
  return()
endif()

# nvcc_wrapper compiles all C++ with nvcc, which is much slower than g++.  Sources without device code
# do not need it.
set(BDH_HOST_ONLY "")
if(Kokkos_ENABLE_CUDA)
  set(BDH_CUDA_GENCODE "arch=compute_90,code=sm_90" CACHE STRING "Architectures in addition to Kokkos_ARCH_..., as for nvcc -gencode")
  foreach(gencode ${BDH_CUDA_GENCODE})
    add_compile_options(-gencode=${gencode})
  endforeach()
  set(BDH_HOST_ONLY --host-only)
endif()

# bdh_host_only(TARGET): compiles LAMMPS' sources that use no header of Kokkos for the host only.
# These sources include neither such a header nor a list of styles.
function(bdh_host_only target)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "^${BDH_LAMMPS_DIR}/src/.*\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "/KOKKOS/")
  foreach(source ${sources})
    file(STRINGS ${source} kokkos LIMIT_COUNT 1 REGEX "#include *\"(style_|.*kokkos)")
    if(NOT kokkos)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES COMPILE_OPTIONS "${BDH_HOST_ONLY}")
    endif()
  endforeach()
endfunction()

# Debian's source of LAMMPS lacks the bundled Kokkos, so LAMMPS needs EXTERNAL_KOKKOS=ON and looks for
# an installed package.  It finds this one, whose targets already exist.
function(bdh_pretend_installed_kokkos dir)
  file(WRITE ${dir}/KokkosConfig.cmake "# Kokkos is part of this build.\n")
  file(WRITE ${dir}/KokkosConfigVersion.cmake
    "set(PACKAGE_VERSION 3.4.01)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\nset(PACKAGE_VERSION_EXACT TRUE)\n")
endfunction()

function(bdh_build_kokkos)
  if(NOT EXISTS ${BDH_KOKKOS_SOURCE_DIR}/cmake/KokkosCore_config.h.in)
    message(FATAL_ERROR
      "There is no source of Kokkos in ${BDH_KOKKOS_SOURCE_DIR}.  Run 'BDH_KOKKOS=openmp "
      "cmake/prepare.sh', which gets it from Debian, or set -DBDH_KOKKOS_SOURCE_DIR=dir to an unpacked "
      "Kokkos 3.4.01, or use an installed one with -DEXTERNAL_KOKKOS=ON -DKokkos_ROOT=dir.")
  endif()
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_EXTENSIONS OFF)
  option(Kokkos_ENABLE_SERIAL "" ON)
  option(Kokkos_ENABLE_CUDA_LAMBDA "" ${Kokkos_ENABLE_CUDA})    # LAMMPS needs it
  add_subdirectory(${BDH_KOKKOS_SOURCE_DIR} ${CMAKE_BINARY_DIR}/kokkos EXCLUDE_FROM_ALL)
endfunction()

if(EXTERNAL_KOKKOS)
  # A version given here would refuse other major versions, where Kokkos' own file asks for the same one.
  find_package(Kokkos REQUIRED CONFIG)
  if(Kokkos_VERSION VERSION_LESS 3.4)
    message(FATAL_ERROR "Kokkos ${Kokkos_VERSION} in ${Kokkos_DIR} is too old: BD-HYDRO needs 3.4 or newer.  "
      "Set -DKokkos_ROOT=dir to where a newer one is installed.")
  endif()
  # Debian's package names /usr/lib/include, which does not exist.
  get_target_property(include_dirs Kokkos::kokkos INTERFACE_INCLUDE_DIRECTORIES)
  if(include_dirs AND NOT EXISTS "${include_dirs}" AND Kokkos_INCLUDE_DIRS)
    set_target_properties(Kokkos::kokkos PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${Kokkos_INCLUDE_DIRS}")
  endif()
else()
  bdh_build_kokkos()
  bdh_pretend_installed_kokkos(${CMAKE_BINARY_DIR}/kokkos-config)
  set(Kokkos_DIR ${CMAKE_BINARY_DIR}/kokkos-config)
  set(EXTERNAL_KOKKOS ON)                     # for LAMMPS, only in this run of cmake
  set(CMAKE_POLICY_DEFAULT_CMP0077 NEW)       # so that LAMMPS' option() keeps this value
endif()
