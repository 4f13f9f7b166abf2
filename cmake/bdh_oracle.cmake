# The dense Rotne-Prager-Yamakawa mobility is a reference for tests and benchmarks.  The package
# itself does not use it.
add_library(bdh_oracle STATIC
  ${CMAKE_SOURCE_DIR}/unittest/oracle/dense_rpy.cpp ${CMAKE_SOURCE_DIR}/unittest/oracle/dense_spheres.cpp)
target_include_directories(bdh_oracle PUBLIC ${CMAKE_SOURCE_DIR}/unittest)
target_link_libraries(bdh_oracle PUBLIC bdh_core)
target_compile_options(bdh_oracle PRIVATE -Wall -Wextra)
