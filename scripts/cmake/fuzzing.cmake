# cmake -C scripts/cmake/fuzzing.cmake: the fuzz targets for libFuzzer, under AddressSanitizer and UndefinedBehaviorSanitizer.
set(CMAKE_BUILD_TYPE Debug CACHE STRING "")
set(CSCD_FUZZ ON CACHE BOOL "")
set(BUILD_TESTING OFF CACHE BOOL "")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
    CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_DEBUG "-fsanitize=address,undefined" CACHE STRING "")
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON CACHE BOOL "")
set(CSCD_WARNINGS_AS_ERRORS ON CACHE BOOL "")
