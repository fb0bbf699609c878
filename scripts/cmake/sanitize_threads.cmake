# cmake -C scripts/cmake/sanitize_threads.cmake: ThreadSanitizer; programs of scripts/check threads end at its first finding.
set(CMAKE_BUILD_TYPE Debug CACHE STRING "")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g -fsanitize=thread -fno-omit-frame-pointer" CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_DEBUG "-fsanitize=thread" CACHE STRING "")
set(CSCD_VIEWER OFF CACHE BOOL "")  # nothing of it runs on threads
set(CSCD_WARNINGS_AS_ERRORS ON CACHE BOOL "")
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON CACHE BOOL "")  # rooms share them, and those that link oneTBB have a definition more
