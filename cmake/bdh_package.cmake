# The styles, compiled into LAMMPS' own library (cmake/lammps.cmake registers them).
file(GLOB BDH_STYLE_SOURCES CONFIGURE_DEPENDS
     ${BDH_SOURCE_DIR}/compute_*.cpp ${BDH_SOURCE_DIR}/fix_*.cpp ${BDH_SOURCE_DIR}/pair_*.cpp ${BDH_SOURCE_DIR}/bdh_*.cpp)

target_sources(lammps PRIVATE ${BDH_STYLE_SOURCES})
target_include_directories(lammps PRIVATE ${BDH_SOURCE_DIR})
target_compile_features(lammps PRIVATE cxx_std_17)    # LAMMPS requests C++11 but compiles as C++17
target_link_libraries(lammps PUBLIC bdh_core)
set_property(SOURCE ${BDH_SOURCE_DIR}/bdh_lammps.cpp TARGET_DIRECTORY lammps
  PROPERTY COMPILE_DEFINITIONS BDH_VERSION="${bd_hydro_VERSION}")

if(PKG_KOKKOS)
  file(GLOB BDH_KOKKOS_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kokkos/*_kokkos.cpp)
  target_sources(lammps PRIVATE ${BDH_KOKKOS_SOURCES})
  target_include_directories(lammps PRIVATE ${CMAKE_SOURCE_DIR}/kokkos)
  # LMP_KOKKOS is public, so everything that includes LAMMPS includes Kokkos.
  target_link_libraries(lammps PUBLIC Kokkos::kokkos)
  if(Kokkos_ENABLE_CUDA)
    find_package(CUDAToolkit REQUIRED)
    target_link_libraries(lammps PUBLIC CUDA::cufft)
  endif()
  if(BDH_HOST_ONLY)
    bdh_host_only(lammps)
  endif()

  # Compiles only our device code, so that cmake/check_cuda.sh sees nvcc's messages about it without
  # those about LAMMPS.
  if(Kokkos_ENABLE_CUDA)
    add_library(bdh_device_code OBJECT EXCLUDE_FROM_ALL
      ${BDH_KOKKOS_SOURCES} ${CMAKE_SOURCE_DIR}/unittest/kokkos/test_device_kernels.cpp)
    target_include_directories(bdh_device_code PRIVATE $<TARGET_PROPERTY:lammps,INCLUDE_DIRECTORIES>)
    target_compile_definitions(bdh_device_code PRIVATE $<TARGET_PROPERTY:lammps,COMPILE_DEFINITIONS>)
    # 20011, 20012, 20014: a device function calls a host function.
    target_compile_options(bdh_device_code PRIVATE -Xptxas=-v
      "SHELL:-Xcudafe --diag_error=20011" "SHELL:-Xcudafe --diag_error=20012" "SHELL:-Xcudafe --diag_error=20014")
    target_link_libraries(bdh_device_code PRIVATE bdh_core Kokkos::kokkos MPI::MPI_CXX)
  endif()
endif()
