# SPDX-License-Identifier: BSD-3-Clause

set(LINTEL_DEPENDENCIES_FILE ${CMAKE_CURRENT_LIST_DIR}/dependencies)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${LINTEL_DEPENDENCIES_FILE})
file(STRINGS ${LINTEL_DEPENDENCIES_FILE} lintel_dependency_lines REGEX "^[a-z0-9]")
set(LINTEL_DEBIAN_PACKAGES)
foreach(line IN LISTS lintel_dependency_lines)
  string(REGEX MATCH "^[a-z0-9.+-]+" package "${line}")
  list(APPEND LINTEL_DEBIAN_PACKAGES ${package})
endforeach()

# lintel_require(NAME DEBIAN_PACKAGE [argument…]): find_package(NAME argument…); where that fails, says what to install.
# A macro, as find_package sets variables for its caller.
macro(lintel_require NAME DEBIAN_PACKAGE)
  if(NOT ${DEBIAN_PACKAGE} IN_LIST LINTEL_DEBIAN_PACKAGES)
    message(FATAL_ERROR "${DEBIAN_PACKAGE} is missing in packaging/dependencies: add it, with the reason")
  endif()
  find_package(${NAME} ${ARGN} QUIET)
  if(NOT ${NAME}_FOUND)
    list(JOIN LINTEL_DEBIAN_PACKAGES " " lintel_all_packages)
    message(FATAL_ERROR "${NAME} was not found. On Debian it is in ${DEBIAN_PACKAGE}; everything needed:\n"
                        "  apt-get install ${lintel_all_packages}")
  endif()
endmacro()
