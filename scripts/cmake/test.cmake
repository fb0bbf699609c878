# cmake -C scripts/cmake/test.cmake: the release build with this project's assertions on, for the test suite. Those of Eigen and CGAL
# stay off, because they are in the innermost loops.
include(${CMAKE_CURRENT_LIST_DIR}/release.cmake)
# FORCE: a folder that was configured without assertions has other flags in its cache.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DEIGEN_NO_DEBUG -DCGAL_NDEBUG" CACHE STRING "" FORCE)
set(CSCD_UNTIMED ON CACHE BOOL "")
set(CSCD_WARNINGS_AS_ERRORS ON CACHE BOOL "")
# Test programs are linked by the dozen; gold, which Debian 12 has beside its usual linker, takes a third of the time.
find_program(CSCD_GOLD ld.gold)
if(CSCD_GOLD)
  set(CMAKE_EXE_LINKER_FLAGS "-fuse-ld=gold" CACHE STRING "")
endif()
