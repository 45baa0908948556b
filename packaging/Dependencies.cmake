# SPDX-License-Identifier: BSD-3-Clause

set(LINTEL_DEPENDENCIES_FILE ${CMAKE_CURRENT_LIST_DIR}/dependencies)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${LINTEL_DEPENDENCIES_FILE})
file(STRINGS ${LINTEL_DEPENDENCIES_FILE} lintel_dependency_lines REGEX "^[a-z0-9]")
set(LINTEL_DEBIAN_PACKAGES)
foreach(line IN LISTS lintel_dependency_lines)
  string(REGEX MATCH "^[a-z0-9.+-]+" package "${line}")
  list(APPEND LINTEL_DEBIAN_PACKAGES ${package})
endforeach()

function(lintel_check_listed DEBIAN_PACKAGE)
  if(NOT DEBIAN_PACKAGE IN_LIST LINTEL_DEBIAN_PACKAGES)
    message(FATAL_ERROR "${DEBIAN_PACKAGE} is missing in packaging/dependencies: add it, with the reason")
  endif()
endfunction()

function(lintel_missing NAME DEBIAN_PACKAGE)
  list(JOIN LINTEL_DEBIAN_PACKAGES " " all_packages)
  message(FATAL_ERROR "${NAME} was not found. On Debian it is in ${DEBIAN_PACKAGE}; everything needed:\n"
                      "  apt-get install ${all_packages}")
endfunction()

# lintel_require(NAME DEBIAN_PACKAGE [argument…]): find_package(NAME argument…); where that fails, says what to install.
# LINTEL_REQUIRED collects the calls, for the installed package configuration.
# A macro, as find_package sets variables for its caller.
macro(lintel_require NAME DEBIAN_PACKAGE)
  lintel_check_listed(${DEBIAN_PACKAGE})
  find_package(${NAME} ${ARGN} QUIET)
  if(NOT ${NAME}_FOUND)
    lintel_missing(${NAME} ${DEBIAN_PACKAGE})
  endif()
  string(JOIN " " lintel_call ${NAME} ${ARGN})
  list(APPEND LINTEL_REQUIRED "${lintel_call}")
endmacro()

# lintel_require_library(NAME DEBIAN_PACKAGE HEADER LIBRARY): the same for a library without a CMake configuration; sets
# NAME_INCLUDE_DIR and NAME_LIBRARY.
macro(lintel_require_library NAME DEBIAN_PACKAGE HEADER LIBRARY)
  lintel_check_listed(${DEBIAN_PACKAGE})
  find_path(${NAME}_INCLUDE_DIR ${HEADER})
  find_library(${NAME}_LIBRARY ${LIBRARY})
  if(NOT ${NAME}_INCLUDE_DIR OR NOT ${NAME}_LIBRARY)
    lintel_missing(${NAME} ${DEBIAN_PACKAGE})
  endif()
endmacro()
