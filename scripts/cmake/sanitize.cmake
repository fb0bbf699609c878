# cmake -C scripts/cmake/sanitize.cmake: AddressSanitizer, UndefinedBehaviorSanitizer and the assertions of libstdc++, any
# finding is fatal.
set(CMAKE_BUILD_TYPE Debug CACHE STRING "")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-maybe-uninitialized" CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_DEBUG "-fsanitize=address,undefined" CACHE STRING "")
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON CACHE BOOL "")  # every file includes what it uses
set(CSCD_UNITY OFF CACHE BOOL "")
set(CSCD_WARNINGS_AS_ERRORS ON CACHE BOOL "")
