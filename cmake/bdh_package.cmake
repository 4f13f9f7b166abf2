# The styles, compiled into LAMMPS' own library, and their variants for Kokkos.  Also copied into LAMMPS
# trees by copy_to_lammps.sh.  BDH_SOURCE_DIR and BDH_KOKKOS_DIR say where the sources are,
# BDH_BACKPORTS_DIR where those of styles that this LAMMPS lacks.
file(GLOB BDH_STYLE_SOURCES CONFIGURE_DEPENDS
     ${BDH_SOURCE_DIR}/compute_*.cpp ${BDH_SOURCE_DIR}/fix_*.cpp ${BDH_SOURCE_DIR}/pair_*.cpp ${BDH_SOURCE_DIR}/bdh_*.cpp)

target_sources(lammps PRIVATE ${BDH_STYLE_SOURCES})
target_include_directories(lammps PRIVATE ${BDH_SOURCE_DIR})
target_compile_features(lammps PRIVATE cxx_std_17)    # LAMMPS itself requests an older standard
target_link_libraries(lammps PRIVATE bdh_core)
set_property(SOURCE ${BDH_SOURCE_DIR}/bdh_lammps.cpp TARGET_DIRECTORY lammps
  PROPERTY COMPILE_DEFINITIONS BDH_VERSION="${bd_hydro_VERSION}")

if(PKG_KOKKOS)
  file(GLOB BDH_KOKKOS_SOURCES CONFIGURE_DEPENDS ${BDH_KOKKOS_DIR}/*_kokkos.cpp)
  if(BDH_BACKPORTS_DIR)
    file(GLOB backports CONFIGURE_DEPENDS ${BDH_BACKPORTS_DIR}/*_kokkos.cpp)
    list(APPEND BDH_KOKKOS_SOURCES ${backports})
  endif()
  target_sources(lammps PRIVATE ${BDH_KOKKOS_SOURCES})
  target_include_directories(lammps PRIVATE ${BDH_KOKKOS_DIR} ${BDH_BACKPORTS_DIR})
  if(Kokkos_ENABLE_CUDA)
    find_package(CUDAToolkit REQUIRED)
    target_link_libraries(lammps PUBLIC CUDA::cufft)
  endif()
endif()
