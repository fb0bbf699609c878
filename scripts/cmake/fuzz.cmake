# Fuzz targets (fuzz/target.h).
#
#   cscd_fuzz_target(NAME RANDOM ROOM... [STORED FILE...])   fuzz/NAME.cpp, which uses the rooms
#
# With CSCD_FUZZ each target is a program for libFuzzer, fuzz_NAME (scripts/find-faults fuzz). Without, it is a test that runs what is
# stored for it, in fuzz/corpus/NAME and in the files, and RANDOM inputs made from that.
option(CSCD_FUZZ "Build the fuzz targets for libFuzzer; needs clang" OFF)

function(cscd_fuzz_target name random)
  if(NOT CSCD_FUZZ AND NOT BUILD_TESTING)
    return()
  endif()
  cmake_parse_arguments(FUZZ "" "" "STORED" ${ARGN})
  set(folder ${PROJECT_SOURCE_DIR}/fuzz)
  string(REPLACE "/" "_" rooms "${FUZZ_UNPARSED_ARGUMENTS}")
  if(CSCD_FUZZ)
    set(program fuzz_${name})
    add_executable(${program} ${folder}/${name}.cpp ${folder}/entry.cpp)
    target_link_options(${program} PRIVATE -fsanitize=fuzzer)
  else()
    set(program fuzz_${name}_replay)
    if(NOT TARGET fuzz_replay)
      add_library(fuzz_replay OBJECT ${folder}/replay.cpp)
      target_include_directories(fuzz_replay PRIVATE ${PROJECT_SOURCE_DIR})
      target_link_libraries(fuzz_replay PRIVATE cscd_flags)
    endif()
    add_executable(${program} ${folder}/${name}.cpp $<TARGET_OBJECTS:fuzz_replay>)
    target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
    set(stored ${FUZZ_STORED})
    if(IS_DIRECTORY ${folder}/corpus/${name})
      list(APPEND stored ${folder}/corpus/${name})
    endif()
    add_test(NAME fuzz_${name} COMMAND ${program} --random ${random} ${stored})
  endif()
  # One of them compares with the fractions of GMP.
  target_link_libraries(${program} PRIVATE ${rooms} ${GMPXX_LIBRARY} ${GMP_LIBRARY} cscd_flags)
endfunction()
