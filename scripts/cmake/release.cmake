# cmake -C scripts/cmake/release.cmake: the build that is measured (assertions off, this machine's SIMD).
set(CMAKE_BUILD_TYPE Release CACHE STRING "")
set(CSCD_NATIVE ON CACHE BOOL "")
