# cmake -C scripts/cmake/debug.cmake: assertions on, those of libstdc++ too, lightly optimised so that the test suite stays usable.
set(CMAKE_BUILD_TYPE Debug CACHE STRING "")
set(CMAKE_CXX_FLAGS_DEBUG "-Og -g -D_GLIBCXX_ASSERTIONS" CACHE STRING "")
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON CACHE BOOL "")  # every file includes what it uses
set(CSCD_UNITY OFF CACHE BOOL "")
set(CSCD_WARNINGS_AS_ERRORS ON CACHE BOOL "")
