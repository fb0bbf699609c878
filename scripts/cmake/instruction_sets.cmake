# One build for every x86-64. With CSCD_ALL_ISAS the engine is compiled for each of these instruction sets, and what is
# linked from it chooses when it runs: core/base/instruction_set.cpp asks the machine for just these options.
#
# The library holds a *copy* of the engine for each set: everything compiled for the set, linked to one object, in which all
# names but one are made local. A function that two copies share by name, such as an inline one of a header, thus exists once
# in each, and the linker cannot take one that is compiled for AVX-512 where another copy calls it.
#
# The program is linked once for each set. `cscd` runs everywhere; its first act is to run `cscd-avx2` or `cscd-avx512`
# beside it where the machine has that set.
set(CSCD_WIDE_ISAS avx2 avx512)
set(CSCD_OPTIONS_avx2 -mavx2 -mfma -mbmi -mbmi2 -mpopcnt)
set(CSCD_OPTIONS_avx512 ${CSCD_OPTIONS_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl)
set(all_isas_by_default ON)
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" OR CSCD_NATIVE OR CMAKE_BUILD_TYPE STREQUAL Debug
   OR CMAKE_CXX_FLAGS MATCHES "-march=|-mavx")
  set(all_isas_by_default OFF)
endif()
option(CSCD_ALL_ISAS "Compile for AVX-512, AVX2 and plain x86-64, and choose at run time" ${all_isas_by_default})
if(CSCD_ALL_ISAS)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    message(FATAL_ERROR "CSCD_ALL_ISAS is for x86-64; configure without it for ${CMAKE_SYSTEM_PROCESSOR}")
  endif()
  if(CSCD_NATIVE OR CMAKE_CXX_FLAGS MATCHES "-march=|-mavx")
    message(FATAL_ERROR "CSCD_ALL_ISAS compiles for each instruction set; configure with it or with one set, not both: "
                        "-DCSCD_ALL_ISAS=OFF")
  endif()
endif()

# cscd_rooms_below(OUT REGEX ROOM...): all rooms that are reached from the given ones, these included, whose names match.
function(cscd_rooms_below out regex)
  set(seen "")
  set(todo ${ARGN})
  while(todo)
    list(POP_FRONT todo next)
    if(next IN_LIST seen OR NOT TARGET ${next})
      continue()
    endif()
    list(APPEND seen ${next})
    get_target_property(linked ${next} INTERFACE_LINK_LIBRARIES)
    if(linked)
      list(APPEND todo ${linked})
    endif()
  endwhile()
  list(FILTER seen INCLUDE REGEX "${regex}")
  set(${out} ${seen} PARENT_SCOPE)
endfunction()

# cscd_room_objects(OUT ROOM...): the objects of rooms as they are compiled for the tests and for every machine.
function(cscd_room_objects out)
  set(objects "")
  foreach(room IN LISTS ARGN)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      # CMake counts headers that are parsed once among the objects.
      list(APPEND objects $<FILTER:$<TARGET_OBJECTS:${room}>,EXCLUDE,cmake_pch>)
    endif()
  endforeach()
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# cscd_compile_for(OUT ISA NAME ROOM...): compiles the sources of rooms once more, for ISA, as NAME.
function(cscd_compile_for out isa name)
  set(sources "")
  foreach(room IN LISTS ARGN)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      get_target_property(own ${room} SOURCES)
      list(APPEND sources ${own})
    endif()
  endforeach()
  add_library(${name} OBJECT ${sources})
  target_compile_options(${name} PRIVATE ${CSCD_OPTIONS_${isa}})
  target_link_libraries(${name} PRIVATE ${ARGN} cscd_flags)
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${name} PRIVATE ${CSCD_PARSED_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${CSCD_PARSED})
  endif()
  set(${out} $<FILTER:$<TARGET_OBJECTS:${name}>,EXCLUDE,cmake_pch> PARENT_SCOPE)
endfunction()

# cscd_hide_copy(OUT ISA ENTRY SOURCE OBJECT...): links SOURCE, in which the macro CSCD_COPY is ENTRY, and OBJECTs to one
# object that shows the name ENTRY alone.
function(cscd_hide_copy out isa entry source)
  add_library(${entry} OBJECT ${source})
  target_compile_definitions(${entry} PRIVATE CSCD_COPY=${entry})
  target_compile_options(${entry} PRIVATE ${CSCD_OPTIONS_${isa}})
  target_include_directories(${entry} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/library/include)
  target_link_libraries(${entry} PRIVATE Eigen3::Eigen cscd_flags)
  set(objects $<TARGET_OBJECTS:${entry}> ${ARGN})
  set(object ${PROJECT_BINARY_DIR}/${entry}.o)
  # A constructor of a static object would run whatever set is chosen: the last command refuses them.
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object}.whole "${objects}"
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${entry} ${object}.whole ${object}
    COMMAND ${CMAKE_COMMAND} -D OBJDUMP=${CMAKE_OBJDUMP} -D OBJECT=${object} -D ENTRY=${entry}
            -P ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
    DEPENDS "${objects}" ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
    COMMAND_EXPAND_LISTS VERBATIM COMMENT "Linking the copy for ${isa}")
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${out} ${object} PARENT_SCOPE)
endfunction()

# cscd_program_for_each_isa(PROGRAM MAIN ROOM): links PROGRAM-avx2 and PROGRAM-avx512 beside PROGRAM. The rooms of the engine
# and of the baselines are compiled for the set; the others are those of PROGRAM. Such a program runs only where its set is,
# so it may take any compiled form of an inline function.
function(cscd_program_for_each_isa program main room)
  cscd_rooms_below(wide "^(core|baselines)(_|$)" ${room})
  get_property(in_library GLOBAL PROPERTY cscd_library_rooms)
  list(REMOVE_ITEM wide ${in_library})
  foreach(isa IN LISTS CSCD_WIDE_ISAS)
    cscd_compile_for(objects ${isa} ${program}_${isa} ${wide})
    add_executable(${program}-${isa} ${main} ${objects} $<TARGET_OBJECTS:cscd_library_${isa}>)
    target_link_libraries(${program}-${isa} PRIVATE ${room} cscd_flags)
    add_dependencies(${program} ${program}-${isa})
    install(TARGETS ${program}-${isa} COMPONENT program)
  endforeach()
  target_compile_definitions(${program} PRIVATE CSCD_ALL_ISAS)
endfunction()
