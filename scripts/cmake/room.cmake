# A room is one folder: every x.cpp in it is the room's library, every x_test.cpp the room's test program.
#
#   cscd_room(core/mesh USES core/base LINK Eigen3::Eigen TEST_USES scenes TEST_LINK gmp)
#
# USES names the rooms below it, LINK outside libraries, TEST_USES and TEST_LINK those that only its tests may see.
# IF names a variable: where it is false, for want of an outside library, the room stays empty; where it is true, those
# who use the room see a macro, CSCD_BASELINES_FCL for baselines/fcl.
function(cscd_room path)
  cmake_parse_arguments(ROOM "" "IF" "USES;LINK;TEST_USES;TEST_LINK" ${ARGN})
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
    target_link_libraries(${room}_test PRIVATE ${room} ${test_below} ${ROOM_TEST_LINK} GTest::gtest_main cscd_flags)
    gtest_discover_tests(${room}_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 900)
  endif()
endfunction()
