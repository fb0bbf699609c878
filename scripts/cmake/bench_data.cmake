# What the program knows about its own build, and the data files that it carries.
#
#   cscd_build_info(ROOM)   for the room that includes these two headers:
#
# build_info.h   compiler, flags and library versions, written when CMake configures, for each configuration
# commit.h       the commit and whether the sources differ from it: asked from git at every build, so that a record
#                never names an older state than the binary's
#
#   cscd_bench_data(ROOM)   for the room that declares data_files():
#
# data_files.cpp   bench/**.json, so that the program needs no files of its own beside it
function(cscd_build_info room)
  set(generated ${PROJECT_BINARY_DIR}/generated)
  get_target_property(room_options cscd_flags INTERFACE_COMPILE_OPTIONS)
  list(FILTER room_options EXCLUDE REGEX "\\$<")
  set(instruction_sets "this set alone")
  if(CSCD_ALL_ISAS)
    set(instruction_sets "avx512, avx2 and baseline")
  endif()
  set(folder ${generated})
  set(build_types ${CMAKE_BUILD_TYPE})
  if(CSCD_MULTI_CONFIG)
    set(build_types ${CMAKE_CONFIGURATION_TYPES})
    target_include_directories(${room} PUBLIC ${generated}/$<CONFIG>)
  endif()
  foreach(build_type IN LISTS build_types)
    string(TOUPPER "${build_type}" type)
    string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${room_options})
    if(CSCD_NATIVE)
      string(APPEND flags " -march=native")
    endif()
    if(CSCD_MULTI_CONFIG)
      set(folder ${generated}/${build_type})
    endif()
    configure_file(${PROJECT_SOURCE_DIR}/scripts/cmake/build_info.h.in ${folder}/build_info.h @ONLY)
  endforeach()

  add_custom_target(cscd_commit
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUT=${generated}/commit.h
            -P ${PROJECT_SOURCE_DIR}/scripts/cmake/commit.cmake
    BYPRODUCTS ${generated}/commit.h
    COMMENT "")
  target_include_directories(${room} PUBLIC ${generated})
  add_dependencies(${room} cscd_commit)
endfunction()

function(cscd_bench_data room)
  set(generated ${PROJECT_BINARY_DIR}/generated)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bench/*.json)
  set(rows "")
  foreach(file ${files})
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND rows "    {\"${name}\", R\"data(${text})data\"},\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  file(CONFIGURE OUTPUT ${generated}/data_files.cpp @ONLY CONTENT [[
#include "bench/output/data.h"

namespace cscd::bench {
namespace {
constexpr DataFile kFiles[] = {
@rows@};
}
std::span<const DataFile> data_files() { return kFiles; }
}  // namespace cscd::bench
]])

  target_sources(${room} PRIVATE ${generated}/data_files.cpp)
endfunction()
