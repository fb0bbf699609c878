# cmake -D SOURCE=... -D OUT=commit.h -P commit.cmake: writes the header anew only when it changes.
set(commit unknown)
set(dirty false)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse HEAD OUTPUT_VARIABLE head RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${head})
    # What the program is made of; new results or pages do not make it another program.
    execute_process(COMMAND ${GIT} -C ${SOURCE} status --porcelain -- CMakeLists.txt core baselines bench scenes
                            scripts/cmake
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      set(dirty true)
    endif()
  endif()
endif()
set(text "#pragma once\n\n// Written at every build.\nnamespace cscd::bench::build_info {\n")
string(APPEND text "inline constexpr char kCommit[] = \"${commit}\";\n")
string(APPEND text "inline constexpr bool kDirty = ${dirty};\n}  // namespace cscd::bench::build_info\n")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
