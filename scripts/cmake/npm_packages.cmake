# cmake -P: installs exactly what page/package-lock.json names into the folder TO, and writes STAMP. With DEV also what the
# tests need.
file(MAKE_DIRECTORY ${TO})
foreach(name package.json package-lock.json .npmrc)
  configure_file(${FROM}/${name} ${TO}/${name} COPYONLY)
endforeach()
set(leave_out --omit=dev)
if(DEV)
  set(leave_out)
endif()
execute_process(COMMAND ${NPM} ci --ignore-scripts --prefer-offline ${leave_out} WORKING_DIRECTORY ${TO}
                RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT failed EQUAL 0)
  message(FATAL_ERROR "npm could not fetch the viewer's packages; connect to its registry, or configure with "
                      "-DCSCD_VIEWER=OFF. It said:\n${said}")
endif()
file(TOUCH ${STAMP})
