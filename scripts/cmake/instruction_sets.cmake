# One binary for every x86-64. With CSCD_ALL_ISAS each of these sets has a *copy* of the code: everything compiled for the
# set, linked to one object, in which all names but one are made local. A function that two copies share by name, such as
# an inline one of a header, thus exists once in each, and the linker cannot take one that is compiled for AVX-512 where
# another copy calls it. core/base/instruction_set.cpp asks the machine for just these options.
option(CSCD_ALL_ISAS "Compile for AVX-512, AVX2 and plain x86-64, and choose at run time" OFF)
set(CSCD_ISAS baseline avx2 avx512)
set(CSCD_OPTIONS_baseline "")
set(CSCD_OPTIONS_avx2 -mavx2 -mfma -mbmi -mbmi2 -mpopcnt)
set(CSCD_OPTIONS_avx512 ${CSCD_OPTIONS_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl)
if(CSCD_ALL_ISAS)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    message(FATAL_ERROR "CSCD_ALL_ISAS is for x86-64; configure without it for ${CMAKE_SYSTEM_PROCESSOR}")
  endif()
  if(CSCD_NATIVE OR CMAKE_CXX_FLAGS MATCHES "-march=|-mavx")
    message(FATAL_ERROR "CSCD_ALL_ISAS compiles for each instruction set; configure with it or with one set, not both")
  endif()
endif()

# cscd_copies(OUT ENTRY SOURCE ROOM...): makes one object for each instruction set from the sources of the rooms and from
# SOURCE, in which the macro CSCD_COPY is ENTRY_<set>: the one name that stays visible. OUT is the list of objects.
function(cscd_copies out entry source)
  set(sources "")
  foreach(room IN LISTS ARGN)
    get_target_property(type ${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      get_target_property(own ${room} SOURCES)
      list(APPEND sources ${own})
    endif()
  endforeach()
  set(made "")
  foreach(isa IN LISTS CSCD_ISAS)
    set(name ${entry}_${isa})
    add_library(${name} OBJECT ${sources} ${source})
    target_compile_definitions(${name} PRIVATE CSCD_COPY=${name})
    # Names that gcc makes unique in a process would be shared among the copies.
    target_compile_options(${name} PRIVATE ${CSCD_OPTIONS_${isa}} $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
    foreach(room IN LISTS ARGN)
      target_include_directories(${name} PRIVATE $<TARGET_PROPERTY:${room},INTERFACE_INCLUDE_DIRECTORIES>)
      target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:${room},INTERFACE_COMPILE_DEFINITIONS>)
    endforeach()
    target_link_libraries(${name} PRIVATE Eigen3::Eigen TBB::tbb cscd_flags)
    if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
      target_compile_options(${name} PRIVATE ${CSCD_PARSED_OPTIONS})
      target_precompile_headers(${name} PRIVATE ${CSCD_PARSED})
    endif()
    set(object ${PROJECT_BINARY_DIR}/${name}.o)
    # CMake counts headers that are parsed once among the objects.
    set(objects $<FILTER:$<TARGET_OBJECTS:${name}>,EXCLUDE,cmake_pch>)
    # A constructor of a static object would run whatever set is chosen: the last command refuses them.
    add_custom_command(OUTPUT ${object}
      COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object}.whole "${objects}"
      COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${name} ${object}.whole ${object}
      COMMAND ${CMAKE_COMMAND} -D OBJDUMP=${CMAKE_OBJDUMP} -D OBJECT=${object} -D ENTRY=${name}
              -P ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
      DEPENDS "${objects}" ${PROJECT_SOURCE_DIR}/scripts/cmake/check_copy.cmake
      COMMAND_EXPAND_LISTS VERBATIM COMMENT "Linking the copy for ${isa}")
    set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
    list(APPEND made ${object})
  endforeach()
  set(${out} ${made} PARENT_SCOPE)
endfunction()
