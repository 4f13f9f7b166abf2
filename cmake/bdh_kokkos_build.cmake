# Use of Kokkos that is specific to this build, as opposed to a build in a LAMMPS tree.
if(NOT PKG_KOKKOS)
  return()
endif()
# LMP_KOKKOS is public, so everything that includes LAMMPS includes Kokkos.
target_link_libraries(lammps PUBLIC Kokkos::kokkos)
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
