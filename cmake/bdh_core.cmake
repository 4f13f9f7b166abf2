# The core as a library of its own: LAMMPS' include folder is not on its path, so the core cannot depend on LAMMPS.
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW3 REQUIRED IMPORTED_TARGET fftw3 fftw3f)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)

set(BDH_SOURCE_DIR ${CMAKE_SOURCE_DIR}/src/BD-HYDRO)
set(BDH_CORE_DIR ${BDH_SOURCE_DIR}/core)
file(GLOB BDH_CORE_SOURCES CONFIGURE_DEPENDS ${BDH_CORE_DIR}/*/*.cpp)

add_library(bdh_core STATIC ${BDH_CORE_SOURCES})
target_include_directories(bdh_core PUBLIC ${BDH_CORE_DIR} ${RANDOM123_INCLUDE_DIR})
target_compile_features(bdh_core PUBLIC cxx_std_17)
# g++ 12 sees uninitialised registers inside its own AVX-512 intrinsics, by way of Eigen.
target_compile_options(bdh_core PRIVATE -Wall -Wextra -Wno-maybe-uninitialized ${BDH_HOST_ONLY})
# sqrt and floor need not set errno: without this g++ does not vectorise loops that contain them.
target_compile_options(bdh_core PUBLIC -fno-math-errno)
# The C++ bindings of MPI are gone from the standard, and Open MPI's headers of them warn.
target_compile_definitions(bdh_core PUBLIC OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
target_link_libraries(bdh_core PUBLIC PkgConfig::FFTW3 MPI::MPI_CXX)
target_link_libraries(bdh_core PRIVATE Eigen3::Eigen)
