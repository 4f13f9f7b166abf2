# L2: the styles, compiled into LAMMPS' own library (cmake/lammps.cmake registers them).
file(GLOB BDH_STYLE_SOURCES CONFIGURE_DEPENDS
     ${BDH_SOURCE_DIR}/fix_*.cpp ${BDH_SOURCE_DIR}/pair_*.cpp ${BDH_SOURCE_DIR}/compute_*.cpp
     ${BDH_SOURCE_DIR}/bdh_lammps.cpp)

target_sources(lammps PRIVATE ${BDH_STYLE_SOURCES})
target_include_directories(lammps PRIVATE ${BDH_SOURCE_DIR})
target_compile_features(lammps PRIVATE cxx_std_17)    # LAMMPS asks for C++11 and compiles as C++17
target_link_libraries(lammps PUBLIC bdh_core)

if(PKG_KOKKOS)
  file(GLOB BDH_KOKKOS_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kokkos/*_kokkos.cpp)
  target_sources(lammps PRIVATE ${BDH_KOKKOS_SOURCES})
  target_include_directories(lammps PRIVATE ${CMAKE_SOURCE_DIR}/kokkos)
  target_link_libraries(lammps PUBLIC Kokkos::kokkos)    # LMP_KOKKOS is public: what includes LAMMPS includes Kokkos
  if(BDH_HOST_ONLY)
    bdh_host_only(lammps)
  endif()
endif()
