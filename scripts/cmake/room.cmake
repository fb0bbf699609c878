# Outside headers are much of what compiling costs: the first target that asks for a list of them has them parsed,
# others with the same list take what it made. Every file still includes what it uses: builds that set
# CMAKE_DISABLE_PRECOMPILE_HEADERS (debug, sanitize) see to that.
set(CSCD_PARSED <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <optional> <random> <span> <string>
                <vector> <Eigen/Geometry>)
# gcc 12 forgets that precompiled headers are system headers, and warns of code within std::string.
set(CSCD_PARSED_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
# cscd_parse_once(TARGET LEVEL HEADER...): LEVEL is how far the target is optimised. gcc 14 takes no headers that were parsed at
# another level.
function(cscd_parse_once target level)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  target_compile_options(${target} PRIVATE ${CSCD_PARSED_OPTIONS})
  set(maker_of "cscd_parsed ${level} ${ARGN}")
  get_property(maker GLOBAL PROPERTY "${maker_of}")
  if(maker)
    target_precompile_headers(${target} REUSE_FROM ${maker})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY "${maker_of}" ${target})
  endif()
endfunction()

# The compiler spends most of its time on templates of outside libraries, once for each file that uses them. So the files of a
# room that nobody times, and those of a room's tests, are compiled several at once. Every file still includes what it uses:
# builds that set CSCD_UNITY to OFF (debug, sanitize) see to that. Helpers in the anonymous namespaces of one room need names of
# their own.
option(CSCD_UNITY "Compile several files of a room at once" ON)
function(cscd_compile_together target)
  if(CSCD_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
    # gcc takes a file that another one includes for a header.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# Rooms whose time is recorded: each file is compiled alone, so that no other file changes what the compiler makes of it.
option(CSCD_UNTIMED "Nothing is timed in this build: compile several files at once of these rooms, too, and optimise bench/ less" OFF)
set(CSCD_ROOMS_FILE_BY_FILE "^(core|library|baselines)(/|$)|^bench/measure/(strategies|kernels)$")
# Rooms that run once for each command or file. Optimising these takes longer than it saves.
set(CSCD_BRIEF_ROOMS "^bench/(tables|compare|benchmark|statistics|records|inputs|command_line)(/|$)|^bench/(cli|query|measure)$|^bench/(cli/interface|query/view|measure/studies|measure/shards)$|^scenes/(import|export|exchange|catalog)(/|$)")
# Rooms whose tests reckon themselves for many thousand cases, such as with an oracle; and scenes/export, because headers that
# are parsed with meshoptimizer's macro serve nobody else.
set(CSCD_ROOMS_WHOSE_TESTS_RECKON "^(core|baselines|library)(/|$)|^scenes/(hard|effects|motion|catalog|export)$|^bench/(compare|harness)$")

# A room is one folder: every x.cpp in it is the room's library, every x_test.cpp the room's test program.
#
#   cscd_room(core/mesh USES core/base LINK Eigen3::Eigen TEST_USES scenes)
#
# USES names the rooms below it, LINK outside libraries, TEST_USES the rooms that only its tests may see.
# IF names a variable: where it is false, for want of an outside library, the room stays empty; where it is true, those
# who use the room see a macro, CSCD_BASELINES_FCL for baselines/fcl.
# JSON says that the room links nlohmann's library, and that nearly all of its files include <nlohmann/json.hpp>.
function(cscd_room path)
  cmake_parse_arguments(ROOM "JSON" "IF" "USES;LINK;TEST_USES" ${ARGN})
  set(parsed ${CSCD_PARSED})
  if(ROOM_JSON)
    list(APPEND ROOM_LINK nlohmann_json::nlohmann_json)
    list(APPEND parsed <nlohmann/json.hpp>)
  endif()
  string(REPLACE "/" "_" room ${path})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/*.cpp)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/*_test.cpp)
  if(tests)
    list(REMOVE_ITEM sources ${tests})
  endif()
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(ROOM_IF AND NOT ${ROOM_IF})
    set(sources "")
    set(tests "")
    set(ROOM_LINK "")
  endif()
  string(REPLACE "/" "_" below "${ROOM_USES}")
  string(REPLACE "/" "_" test_below "${ROOM_TEST_USES}")

  if(sources)
    add_library(${room} STATIC ${sources})
    target_include_directories(${room} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${room} PUBLIC ${below} ${ROOM_LINK} PRIVATE cscd_flags)
    set(level full)
    if(CSCD_UNTIMED OR NOT path MATCHES "${CSCD_ROOMS_FILE_BY_FILE}")
      cscd_compile_together(${room})
    endif()
    if(path MATCHES "${CSCD_BRIEF_ROOMS}" OR (CSCD_UNTIMED AND path MATCHES "^bench/"))
      set(level brief)
      target_compile_options(${room} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    cscd_parse_once(${room} ${level} ${parsed})
  else()
    add_library(${room} INTERFACE)
    target_include_directories(${room} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${room} INTERFACE ${below} ${ROOM_LINK})
  endif()

  if(ROOM_IF AND sources)
    string(TOUPPER "CSCD_${room}" macro)
    target_compile_definitions(${room} PUBLIC ${macro})
  endif()

  if(BUILD_TESTING AND tests)
    add_executable(${room}_test ${tests})
    target_link_libraries(${room}_test PRIVATE ${room} ${test_below} ${GMPXX_LIBRARY} ${GMP_LIBRARY} GTest::gtest_main cscd_flags)
    if(WIN32)  # a test's own operator new takes the place of the run-time library's only where that is no DLL
      target_link_options(${room}_test PRIVATE -static)
    endif()
    # Tests may compute with the fractions of GMP. A test often runs once for each time that it is compiled: optimising it takes
    # longer than it saves, but for those that reckon themselves.
    set(optimised -O0)
    if(path MATCHES "${CSCD_ROOMS_WHOSE_TESTS_RECKON}")
      set(optimised -O1)
    endif()
    target_compile_options(${room}_test PRIVATE $<$<CONFIG:Release>:${optimised}>)
    cscd_compile_together(${room}_test)
    cscd_parse_once(${room}_test ${optimised} ${parsed} <gtest/gtest.h>)
    gtest_discover_tests(${room}_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 900)
  endif()
endfunction()
