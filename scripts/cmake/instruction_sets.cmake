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
if(WIN32 OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" OR CSCD_NATIVE OR CMAKE_BUILD_TYPE STREQUAL Debug
   OR CMAKE_CXX_FLAGS MATCHES "-march=|-mavx")
  set(all_isas_by_default OFF)
endif()
option(CSCD_ALL_ISAS "Compile for AVX-512, AVX2 and plain x86-64, and choose at run time" ${all_isas_by_default})
if(CSCD_ALL_ISAS)
  if(WIN32 OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    message(FATAL_ERROR "CSCD_ALL_ISAS is for x86-64 and object files in the format ELF; configure without it for "
                        "${CMAKE_SYSTEM_NAME} on ${CMAKE_SYSTEM_PROCESSOR}")
  endif()
  if(CSCD_NATIVE OR CMAKE_CXX_FLAGS MATCHES "-march=|-mavx")
    message(FATAL_ERROR "CSCD_ALL_ISAS compiles for each instruction set; configure with it or with one set, not both: "
                        "-DCSCD_ALL_ISAS=OFF")
  endif()
  # Beside clang, CMake prefers ld.lld, which does not know --force-group-allocation.
  find_program(CSCD_GNU_LINKER NAMES ld.bfd ld REQUIRED)
  mark_as_advanced(CSCD_GNU_LINKER)
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

# cscd_room_objects(OUT ROOM...): the objects of rooms, or of what cscd_compile_for() makes of rooms.
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

# cscd_room_archives(OUT LIBRARIES ROOM...): the static libraries of rooms, as files and as targets.
function(cscd_room_archives out libraries)
  set(found "")
  foreach(room IN LISTS ARGN)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      list(APPEND found ${room})
    endif()
  endforeach()
  set(${libraries} ${found} PARENT_SCOPE)
  list(TRANSFORM found REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# cscd_compile_for(ISA NAME ROOM...): compiles the sources of rooms once more, for ISA, as the static library NAME.
function(cscd_compile_for isa name)
  set(sources "")
  foreach(room IN LISTS ARGN)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      get_target_property(own ${room} SOURCES)
      list(APPEND sources ${own})
    endif()
  endforeach()
  add_library(${name} STATIC ${sources})
  target_compile_options(${name} PRIVATE ${CSCD_OPTIONS_${isa}})
  target_link_libraries(${name} PRIVATE ${ARGN} cscd_flags)
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${name} PRIVATE ${CSCD_PARSED_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${CSCD_PARSED})
  endif()
endfunction()

# cscd_hide_copy(OUT ISA ROOM...): links all objects of the rooms to one object that shows the name of make_engine() alone
# (library/engine/engine.h). OUT is the object, and cscd_copy_ISA_object the target that makes it.
#
# The objects are linked from static libraries, because those are files for which each generator has a rule: makefiles have none
# for the objects of another target.
function(cscd_hide_copy out isa)
  cscd_room_archives(archives libraries ${ARGN})
  set(object ${PROJECT_BINARY_DIR}/${CSCD_CONFIG_FOLDER}cscd_copy_${isa}.o)
  set(entry _ZN4cscd11make_engineI)  # as compilers spell the beginning of cscd::make_engine<SET>
  # A constructor of a static object would run whatever set is chosen: the last command refuses them.
  add_custom_command(OUTPUT ${object}
    COMMAND ${CSCD_GNU_LINKER} -r --force-group-allocation -o ${object}.whole --whole-archive ${archives}
    COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=${entry}* ${object}.whole ${object}
    COMMAND ${CMAKE_COMMAND} -D OBJDUMP=${CMAKE_OBJDUMP} -D OBJECT=${object} -D ENTRY=${entry}
            -P ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
    DEPENDS ${libraries} ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
    VERBATIM COMMENT "Linking the copy for ${isa}")
  # The static and the shared library both take the object, and makefiles would make it for both at once.
  add_custom_target(cscd_copy_${isa}_object DEPENDS ${object})
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
    cscd_compile_for(${isa} ${program}_${isa} ${wide})
    cscd_room_objects(objects ${program}_${isa} cscd_library_${isa})
    add_executable(${program}-${isa} ${main} ${objects})
    target_link_libraries(${program}-${isa} PRIVATE ${room} cscd_flags)
    add_dependencies(${program} ${program}-${isa})
    install(TARGETS ${program}-${isa} COMPONENT program)
  endforeach()
  target_compile_definitions(${program} PRIVATE CSCD_ALL_ISAS)
endfunction()
