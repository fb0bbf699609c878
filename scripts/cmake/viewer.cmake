# The viewer's page, bundled from page/ by npm's esbuild and carried inside the program.
#
#   cscd_viewer(ROOM)   for the room that declares viewer_page()
#
# With CSCD_VIEWER=OFF no Node is needed, and `cscd view` says that it was built without.
option(CSCD_VIEWER "Carry the viewer of cscd view; its build needs nodejs and npm" ON)
function(cscd_viewer room)
  set(made ${PROJECT_BINARY_DIR}/generated/viewer_page.cpp)
  set(page ${PROJECT_SOURCE_DIR}/page)
  set(copy ${PROJECT_BINARY_DIR}/page)
  if(NOT CSCD_VIEWER)
    file(CONFIGURE OUTPUT ${made} CONTENT [[
#include "bench/query/view/viewer_page.h"
namespace cscd::bench {
std::string_view viewer_page() { return {}; }
std::string_view report_page() { return {}; }
}  // namespace cscd::bench
]])
    target_sources(${room} PRIVATE ${made})
    target_compile_definitions(${room} PUBLIC CSCD_NODE="" CSCD_PAGE_TESTS="" CSCD_PAGE_PACKAGES="")
    return()
  endif()
  find_program(NPM npm)
  find_program(NODE NAMES node nodejs)
  if(NOT NPM OR NOT NODE)
    message(FATAL_ERROR "the viewer needs nodejs and npm; install both, or configure with -DCSCD_VIEWER=OFF")
  endif()
  file(GLOB sources LIST_DIRECTORIES false CONFIGURE_DEPENDS ${page}/*.mjs ${page}/src/*)
  # Packages lie beside the build, so that the sources stay as they are.
  set(packages ${copy}/packages.stamp)
  add_custom_command(OUTPUT ${packages}
    COMMAND ${CMAKE_COMMAND} -D NPM=${NPM} -D FROM=${page} -D TO=${copy} -D DEV=${BUILD_TESTING} -D STAMP=${packages}
            -P ${PROJECT_SOURCE_DIR}/scripts/cmake/npm_packages.cmake
    DEPENDS ${page}/package.json ${page}/package-lock.json ${page}/.npmrc
            ${PROJECT_SOURCE_DIR}/scripts/cmake/npm_packages.cmake
    COMMENT "npm ci (three, esbuild)" VERBATIM)
  add_custom_command(OUTPUT ${made}
    COMMAND ${NODE} ${page}/build.mjs ${copy} ${made}
    DEPENDS ${packages} ${sources}
    COMMENT "Bundling the viewer" VERBATIM)
  target_sources(${room} PRIVATE ${made})
  # For the tests that open a page in a browser.
  target_compile_definitions(${room} PUBLIC CSCD_NODE="${NODE}" CSCD_PAGE_TESTS="${page}/test"
                             CSCD_PAGE_PACKAGES="${copy}")
endfunction()
