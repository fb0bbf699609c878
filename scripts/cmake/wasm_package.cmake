# The npm package: cscd.wasm, linked of the rooms below one room, beside the package's own files in js/ of the build folder.
#
#   cscd_wasm_package(FOLDER ROOM)
function(cscd_wasm_package path room)
  cscd_rooms_below(rooms "^(core|library)(_|$)" ${room})
  cscd_room_objects(objects ${rooms})
  # What runs once a mesh, or decides the few pairs that no filter decides: the package is to be small.
  foreach(room core_mesh core_elementary core_elementary_exact core_detect_start core_crossing core_radial core_fast_clusters core_fast_prepare
          library library_engine)
    target_compile_options(${room} PRIVATE -Oz)
    set_target_properties(${room} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)  # they are parsed at another level
  endforeach()
  foreach(file instruction_set memory thread_pool)  # not the whole room, whose precompiled header others use
    set_source_files_properties(core/base/${file}.cpp TARGET_DIRECTORY core_base PROPERTIES COMPILE_OPTIONS -Oz
      SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
  foreach(file session known_starts obstacles true_motion interval_verdict near_list near_pairs patch_motions)
    set_source_files_properties(core/session/${file}.cpp TARGET_DIRECTORY core_session PROPERTIES COMPILE_OPTIONS -Oz
      SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
  # Looks at all vertices are in lanes already, and what else it holds runs once a look.
  set_source_files_properties(core/session/surface_motion.cpp TARGET_DIRECTORY core_session PROPERTIES COMPILE_OPTIONS
    "-fno-unroll-loops;-fno-vectorize;-fno-slp-vectorize" SKIP_PRECOMPILE_HEADERS ON)
  foreach(file close_integers integer_contact integer_roots integer_signs)
    set_source_files_properties(core/elementary/certified/${file}.cpp TARGET_DIRECTORY core_elementary_certified PROPERTIES
      COMPILE_OPTIONS -Oz SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
  set(folder ${PROJECT_SOURCE_DIR}/${path})
  set(package ${PROJECT_BINARY_DIR}/js)
  add_executable(cscd_wasm ${folder}/bindings.cpp ${folder}/runtime.cpp ${objects})
  target_compile_options(cscd_wasm PRIVATE -Oz)
  set_target_properties(cscd_wasm PROPERTIES OUTPUT_NAME cscd SUFFIX .wasm RUNTIME_OUTPUT_DIRECTORY ${package})
  target_link_libraries(cscd_wasm PRIVATE ${room} cscd_flags)
  # A library without main(). Its stack lies below its data, so that an overflow traps.
  target_link_options(cscd_wasm PRIVATE -mexec-model=reactor -Wl,--stack-first -Wl,-z,stack-size=1048576 -Wl,--strip-all)
  file(GLOB files RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/*.js ${folder}/*.d.ts ${folder}/*.json ${folder}/README.md ${folder}/test/*.mjs ${folder}/test/*.ts)
  foreach(file IN LISTS files)
    configure_file(${folder}/${file} ${package}/${file} COPYONLY)
  endforeach()
endfunction()
