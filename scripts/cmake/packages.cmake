# cpack in a build folder makes Debian's packages: libcscd-dev (library and headers, MIT), python3-cscd, and, where the program
# is built, cscd (GPL, because it links CGAL).
if(CSCD_INSIDE)
  return()  # the packages of a project around this one are its own
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the authors of cscd")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL library)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # derives the libraries a package needs from what its binaries link
set(summary "continuous self-collision detection of deforming triangle meshes")

# cpack installs below a folder of its own, where nothing tells that the prefix will be /usr.
set(CPACK_CUSTOM_INSTALL_VARIABLES CSCD_PYTHON_FOLDER=lib/python3/dist-packages
                                   CSCD_ZSH_FOLDER=share/zsh/vendor-completions)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libcscd-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libeigen3-dev, libtbb-dev")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${summary}: C++ library")
if(TARGET cscd_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-cscd)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  # A module is for one minor version of Python.
  execute_process(COMMAND ${PYTHON_EXECUTABLE} -c "import sys; print(sys.version_info.minor)"
                  OUTPUT_VARIABLE minor OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  math(EXPR next "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "cscd, python3-h5py")  # read() asks the program
  # Whoever imports the module as root makes Python write byte code beside it, which has to go with the package.
  set(moments postinst prerm)
  set(commands py3compile py3clean)
  foreach(at command IN ZIP_LISTS moments commands)
    file(WRITE ${PROJECT_BINARY_DIR}/python3-cscd/${at} "#!/bin/sh\nset -e\n${command} -p python3-cscd\n")
    list(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/python3-cscd/${at})
  endforeach()
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${summary}: Python module")
endif()
if(NOT CSCD_LIBRARY_ONLY)
  list(APPEND CPACK_COMPONENTS_ALL program)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME cscd)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
  set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${summary}: program")
endif()
include(CPack)
