# cmake -DCORE_DIR=<dir> -P check_layers.cmake
# The rules that keep L0 and L1 free of LAMMPS and Kokkos, and foreign libraries each behind one file.
# bdh_lammps.* is glue in spite of its name.
cmake_minimum_required(VERSION 3.20)    # for the policies of if(IN_LIST)

file(GLOB files ${CORE_DIR}/bdh_*.h ${CORE_DIR}/bdh_*.cpp)
list(FILTER files EXCLUDE REGEX "/bdh_lammps\\.")
if(NOT files)
  message(FATAL_ERROR "no core files in '${CORE_DIR}'")
endif()

set(faults "")
macro(refuse pattern why)
  if(text MATCHES "${pattern}")
    string(APPEND faults "${name}: ${why}\n")
  endif()
endmacro()

foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  refuse("LAMMPS_NS" "LAMMPS_NS in the core")
  # LAMMPS registers a style from every header that holds one of these words, even in a comment.
  refuse("(COMMAND|KSPACE|INTEGRATE)_CLASS" "a word that LAMMPS reads as the registration of a style")
  refuse("Kokkos::" "Kokkos:: in the core")
  if(NOT name STREQUAL "bdh_portable.h")
    refuse("#include *[<\"]Kokkos_" "includes Kokkos")
  endif()
  if(NOT name MATCHES "^bdh_(fft|trig)\\.cpp$")
    refuse("#include *[<\"]fftw3" "includes FFTW: only bdh_fft.cpp and bdh_trig.cpp may")
  endif()
  if(NOT name STREQUAL "bdh_comm.h")
    refuse("#include *[<\"]mpi\\.h" "includes mpi.h: only bdh_comm.h may")
  endif()
  refuse("#include *[<\"](lammps|pointers|atom|fix|pair|domain|error|force|memory|update|comm|neigh_list|neighbor)\\.h"
    "includes a header of LAMMPS")
  if(name MATCHES "_kernel\\.h$")
    refuse("#include *<(vector|string|array|map|memory|functional|iostream|stdexcept)>" "a kernel with containers")
    refuse("std::(vector|string|function|unique_ptr|shared_ptr)" "a kernel with containers")
    refuse("[^a-z_](throw|new|malloc) " "a kernel that throws or allocates")
  endif()
endforeach()

if(faults)
  message(FATAL_ERROR "Layers broken:\n${faults}")
endif()
