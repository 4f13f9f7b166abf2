# LAMMPS has hundreds of small sources, which take longer to read the same headers than for all the rest.  With
# BDH_PRECOMPILED_HEADERS these headers are read once.  Our own sources are compiled without, so that an include that
# they lack is still noticed.  Kokkos' header is not among them: it would slow down all sources that do not use it.
if(NOT BDH_PRECOMPILED_HEADERS OR Kokkos_ENABLE_CUDA)    # nvcc cannot
  return()
endif()

# In angle brackets, so that they are the same in every folder and ccache can share them.
set(headers <algorithm> <cmath> <cstring> <map> <set> <string> <unordered_set> <vector>
  <atom.h> <comm.h> <domain.h> <error.h> <fix.h> <force.h> <memory.h> <modify.h> <update.h>)
list(TRANSFORM headers REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:\\1>")
target_precompile_headers(lammps PRIVATE ${headers})

get_target_property(sources lammps SOURCES)
list(FILTER sources EXCLUDE REGEX "^${BDH_LAMMPS_DIR}/src/")
set_source_files_properties(${sources} TARGET_DIRECTORY lammps PROPERTIES SKIP_PRECOMPILE_HEADERS ON)

# What ccache's manual asks for, since otherwise it does not keep what is compiled with such headers.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set_target_properties(lammps PROPERTIES CXX_COMPILER_LAUNCHER
    "env;CCACHE_SLOPPINESS=pch_defines,time_macros;${CMAKE_CXX_COMPILER_LAUNCHER}")
  target_compile_options(lammps PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()
