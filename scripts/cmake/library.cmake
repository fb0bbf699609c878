# The library that others link, made of the objects of the rooms it needs.
#
#   cscd_install_library(ROOM)   the room that holds the public header's functions
#
# With CSCD_ALL_ISAS the library holds a copy of these objects for each instruction set (instruction_sets.cmake).
#
# Targets cscd::cscd_static and cscd::cscd_shared; cscd::cscd is the static one, or with BUILD_SHARED_LIBS the shared
# one. Installed as component `library`: both, the header, a package for find_package(cscd CONFIG), and cscd.pc.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# cscd_chooser(NAME ROOM): the objects of the room of the public header's functions, compiled to choose among engines for all
# instruction sets.
function(cscd_chooser name room)
  get_target_property(sources ${room} SOURCES)
  add_library(${name} OBJECT ${sources} ${PROJECT_SOURCE_DIR}/core/base/instruction_set.cpp)
  target_compile_definitions(${name} PRIVATE CSCD_ALL_ISAS CSCD_BUILDING)
  target_include_directories(${name} PRIVATE $<TARGET_PROPERTY:${room},INTERFACE_INCLUDE_DIRECTORIES>)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen cscd_flags)
endfunction()

function(cscd_install_library room)
  cscd_rooms_below(rooms "^(core|library)(_|$)" ${room})
  set(copies "")
  if(CSCD_ALL_ISAS)
    list(REMOVE_ITEM rooms ${room})
    cscd_hide_copy(objects baseline ${rooms})
    set(copies cscd_copy_baseline_object)
    foreach(isa IN LISTS CSCD_WIDE_ISAS)
      cscd_compile_for(${isa} cscd_library_${isa} ${rooms})
      cscd_hide_copy(hidden ${isa} cscd_library_${isa})
      list(APPEND objects ${hidden})
      list(APPEND copies cscd_copy_${isa}_object)
    endforeach()
    set_property(GLOBAL PROPERTY cscd_library_rooms ${rooms})  # those are compiled for each set
    cscd_chooser(cscd_chooser ${room})
    list(APPEND objects $<TARGET_OBJECTS:cscd_chooser>)
  else()
    cscd_room_objects(objects ${rooms})
  endif()
  foreach(kind static shared)
    string(TOUPPER ${kind} type)
    add_library(cscd_${kind} ${type} ${objects})
    add_library(cscd::cscd_${kind} ALIAS cscd_${kind})
    if(copies)
      add_dependencies(cscd_${kind} ${copies})
    endif()
    set_target_properties(cscd_${kind} PROPERTIES OUTPUT_NAME cscd LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    target_compile_features(cscd_${kind} INTERFACE cxx_std_20)
    target_include_directories(cscd_${kind} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/library/include>
                               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(cscd_${kind} PUBLIC Eigen3::Eigen PRIVATE $<TARGET_NAME_IF_EXISTS:TBB::tbb>)
  endforeach()
  if(BUILD_SHARED_LIBS)
    add_library(cscd::cscd ALIAS cscd_shared)
  else()
    add_library(cscd::cscd ALIAS cscd_static)
  endif()

  install(TARGETS cscd_static cscd_shared EXPORT cscdTargets COMPONENT library)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/library/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/cscd)
  install(EXPORT cscdTargets NAMESPACE cscd:: DESTINATION ${package} COMPONENT library)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/scripts/cmake/cscdConfig.cmake.in
                                ${PROJECT_BINARY_DIR}/cscdConfig.cmake INSTALL_DESTINATION ${package})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/cscdConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  set(CSCD_LINKED "")
  if(TBB_FOUND)
    set(CSCD_LINKED -ltbb)
  endif()
  file(RELATIVE_PATH up_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
  configure_file(${PROJECT_SOURCE_DIR}/scripts/cmake/cscd.pc.in ${PROJECT_BINARY_DIR}/cscd.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/cscdConfig.cmake ${PROJECT_BINARY_DIR}/cscdConfigVersion.cmake
          DESTINATION ${package} COMPONENT library)
  install(FILES ${PROJECT_BINARY_DIR}/cscd.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cscd COMPONENT library)
endfunction()

# The Python module, where pybind11 is installed: the package `cscd` in python/ of the build folder, and component `python`.
function(cscd_python_module path)
  set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the module is for")
  find_package(pybind11 2.10 CONFIG QUIET)
  if(NOT pybind11_FOUND)
    message(STATUS "pybind11 is not installed: no Python module")
    return()
  endif()
  pybind11_add_module(cscd_python NO_EXTRAS ${PROJECT_SOURCE_DIR}/${path}/module.cpp)
  set(package ${PROJECT_BINARY_DIR}/python/cscd)
  # An expression keeps generators of several configurations from appending a folder of theirs.
  set_target_properties(cscd_python PROPERTIES OUTPUT_NAME _cscd LIBRARY_OUTPUT_DIRECTORY $<1:${package}>)
  target_link_libraries(cscd_python PRIVATE cscd_static cscd_flags)
  target_compile_options(cscd_python PRIVATE $<$<CONFIG:Release>:-O1>)  # it hands arrays on, and reckons nothing
  target_compile_definitions(cscd_python PRIVATE CSCD_VERSION="${PROJECT_VERSION}")
  file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/cscd/*.py ${PROJECT_SOURCE_DIR}/${path}/cscd/*.pyi
       ${PROJECT_SOURCE_DIR}/${path}/cscd/py.typed)
  foreach(script IN LISTS scripts)
    get_filename_component(name ${script} NAME)
    configure_file(${script} ${package}/${name} COPYONLY)
  endforeach()
  # The folder depends on the prefix, and installing may name another prefix than configuring did: one below the prefix in
  # which the Python looks for packages, or else where the Python of a virtual environment at the prefix would look.
  execute_process(COMMAND ${PYTHON_EXECUTABLE} -c "import site, sys
print(*site.getsitepackages(), sep=';', end='|lib/python%d.%d/site-packages' % sys.version_info[:2])"
                  OUTPUT_VARIABLE folders COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "^(.*)\\|(.*)$" folders "${folders}")
  install(CODE "
    set(searched \"${CMAKE_MATCH_1}\")
    if(NOT CSCD_PYTHON_FOLDER)
      set(CSCD_PYTHON_FOLDER ${CMAKE_MATCH_2})
      foreach(folder IN LISTS searched)
        string(FIND \"\${folder}\" \"\${CMAKE_INSTALL_PREFIX}/lib\" at)
        if(at EQUAL 0)
          file(RELATIVE_PATH CSCD_PYTHON_FOLDER \"\${CMAKE_INSTALL_PREFIX}\" \"\${folder}\")
          break()
        endif()
      endforeach()
    endif()" COMPONENT python)
  set(destination "\${CSCD_PYTHON_FOLDER}/cscd")
  install(TARGETS cscd_python DESTINATION ${destination} COMPONENT python)
  install(FILES ${scripts} DESTINATION ${destination} COMPONENT python)
endfunction()

# The examples in C++, as tests.
function(cscd_library_examples path)
  file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/examples/*.cpp)
  foreach(example IN LISTS examples)
    get_filename_component(name ${example} NAME_WE)
    add_executable(example_${name} ${example})
    target_link_libraries(example_${name} PRIVATE cscd::cscd cscd_flags)
    add_test(NAME example_${name} COMMAND example_${name})
  endforeach()
endfunction()

# The examples, a consumer outside the tree, and the pages of the interface, as tests.
function(cscd_test_library path)
  # Only a build for all instruction sets links the choice, and such a build takes long. Here every build compiles it.
  if(NOT CSCD_ALL_ISAS)
    cscd_chooser(cscd_chooser library)
  endif()
  # Such a build refuses copies that construct objects before main(). So do others, which take part of the time.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    cscd_rooms_below(rooms "^(core|library)_" library)
    cscd_room_archives(archives libraries ${rooms})
    add_test(NAME nothing_is_constructed_before_main COMMAND bash -c
             "! '${CMAKE_OBJDUMP}' -h \"$@\" | grep -E 'file format| \\.(init_array|ctors)' | grep -B 1 -E 'init_array|ctors'"
             bash ${archives})
  endif()
  cscd_library_examples(${path})
  if(CMAKE_BUILD_TYPE STREQUAL Debug)
    return()  # a library under sanitizers is no use to programs and interpreters without them
  endif()
  add_test(NAME library_consumer COMMAND ${PROJECT_SOURCE_DIR}/${path}/consumer/check ${PROJECT_BINARY_DIR})
  if(TARGET cscd_python)
    set(environment PYTHONPATH=${PROJECT_BINARY_DIR}/python)
    file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/examples/*.py)
    list(FILTER examples EXCLUDE REGEX contact_times)  # a test of the module gives it a clip
    foreach(script IN LISTS examples)
      get_filename_component(name ${script} NAME_WE)
      add_test(NAME example_${name}_py COMMAND /usr/bin/python3 ${script})
      set_tests_properties(example_${name}_py PROPERTIES ENVIRONMENT ${environment})
    endforeach()
    add_test(NAME readme_py COMMAND bash -c "'${PROJECT_SOURCE_DIR}/${path}/doc/snippet' python | /usr/bin/python3 - | grep '^False 0.5'")
    set_tests_properties(readme_py PROPERTIES ENVIRONMENT ${environment})
    add_test(NAME python_module COMMAND /usr/bin/python3 -m unittest discover -s ${PROJECT_SOURCE_DIR}/${path}/python/tests)
    set_tests_properties(python_module PROPERTIES ENVIRONMENT "${environment};CSCD_PROGRAM=${PROJECT_BINARY_DIR}/cscd")
    add_test(NAME python_installs COMMAND ${PROJECT_SOURCE_DIR}/${path}/python/check ${PROJECT_BINARY_DIR})
    # The npm package answers as the module does. A test does not install the packages that its compiler needs.
    find_program(NODE NAMES node nodejs)
    if(NODE)
      add_test(NAME js_package COMMAND ${CMAKE_COMMAND} -E env CSCD_NO_INSTALL=1 ${PROJECT_SOURCE_DIR}/scripts/check wasm ${PROJECT_BINARY_DIR})
      set_tests_properties(js_package PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800 COST 900)
    endif()
  endif()
  find_program(DOXYGEN doxygen)
  if(DOXYGEN)
    configure_file(${PROJECT_SOURCE_DIR}/${path}/doc/Doxyfile ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
    add_test(NAME api_pages WORKING_DIRECTORY ${PROJECT_BINARY_DIR}
             COMMAND bash -c "'${DOXYGEN}' Doxyfile && ls api/html/classcscd_1_1SelfCollision.html")
  endif()
endfunction()
