# SPDX-License-Identifier: BSD-3-Clause

# Nothing here reads errno or the flags of floating-point exceptions: a square root is one instruction then, and more
# loops treat several numbers at once. Results are the same bytes.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options($<$<CONFIG:Release>:-fno-math-errno> $<$<CONFIG:Release>:-fno-trapping-math>)
endif()

# lintel_warnings(TARGET): the warnings every target of the house is compiled with.
function(lintel_warnings TARGET)
  target_compile_options(${TARGET} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
endfunction()

# Headers that most files read, and that take longer to read than the rest of an average file. The first room makes a
# precompiled header of them that all libraries use, and its tests make one for all tests. Files include what they need
# all the same: the presets turn LINTEL_PRECOMPILE on, and packages are built without.
option(LINTEL_PRECOMPILE "Build faster by precompiled headers" OFF)
set(LINTEL_PRECOMPILED
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <numeric> <optional>
  <set> <sstream> <stdexcept> <string> <unordered_map> <utility> <vector> <Eigen/Core> <Eigen/Geometry>)

# lintel_precompile(TARGET FIRST HEADER…): TARGET makes the precompiled header if it is FIRST, else uses that of FIRST.
function(lintel_precompile TARGET FIRST)
  if(NOT LINTEL_PRECOMPILE)
    return()
  endif()
  if("${TARGET}" STREQUAL "${FIRST}")
    target_precompile_headers(${TARGET} PRIVATE ${ARGN})
  else()
    target_precompile_headers(${TARGET} REUSE_FROM ${FIRST})
  endif()
  # with it ccache can cache the files that use a precompiled header (packaging/setup.sh)
  target_compile_options(${TARGET} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

# GCC's garbage collection walks a precompiled header each time, a tenth of the time to compile: only above 1 GB.
if(LINTEL_PRECOMPILE)
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
endif()

# GNU gold links in a third of the time of ld. Packages are linked by the distribution's linker.
option(LINTEL_GOLD "Build faster by linking with gold, where there is one" OFF)
if(LINTEL_GOLD)
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=gold LINTEL_HAS_GOLD)
  if(LINTEL_HAS_GOLD)
    add_link_options(-fuse-ld=gold)
  endif()
endif()

# Several sources at a time: headers are read and templates that they share instantiated once.
option(LINTEL_UNITY "Build faster by compiling sources of a room together" OFF)

# lintel_unity(TARGET BATCH): TARGET is compiled so, BATCH sources at a time, if LINTEL_UNITY says it.
function(lintel_unity TARGET BATCH)
  if(LINTEL_UNITY)
    set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${BATCH})
  endif()
endfunction()

# lintel_test_options(TARGET): how the sources of tests are compiled.
function(lintel_test_options TARGET)
  lintel_warnings(${TARGET})
  target_link_libraries(${TARGET} PRIVATE Eigen3::Eigen GTest::gtest GTest::gmock)
  # tests are small and run once: half of the time to compile them is optimisation
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O1>)
  lintel_precompile(${TARGET} geometry_tests ${LINTEL_PRECOMPILED} <gmock/gmock.h> <gtest/gtest.h>)
endfunction()

# lintel_test_executable(TARGET file…): a program of GoogleTest's cases.
function(lintel_test_executable TARGET)
  add_executable(${TARGET} ${ARGN})
  lintel_test_options(${TARGET})
  target_link_libraries(${TARGET} PRIVATE GTest::gtest_main)
endfunction()

# lintel_tool(TARGET file…): a program that measures, not installed.
function(lintel_tool TARGET)
  add_executable(${TARGET} ${ARGN})
  lintel_warnings(${TARGET})
  lintel_unity(${TARGET} 6)
  lintel_precompile(${TARGET} lintel_geometry ${LINTEL_PRECOMPILED})
endfunction()

# lintel_allocator(TARGET): a program whose malloc is mimalloc's, although no object names it. Sanitizers bring their own.
function(lintel_allocator TARGET)
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    target_link_options(${TARGET} BEFORE PRIVATE -Wl,--push-state,--no-as-needed $<TARGET_FILE:mimalloc> -Wl,--pop-state)
    target_sources(${TARGET} PRIVATE ${PROJECT_SOURCE_DIR}/apps/OperatorNew.cpp)
  endif()
endfunction()

# Seconds after which a test counts as hanging; with sanitizers programs take ten times as long and more.
set(LINTEL_TEST_TIMEOUT 300)
set(LINTEL_LONG_TEST_TIMEOUT 900)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(LINTEL_TEST_TIMEOUT 3600)
  set(LINTEL_LONG_TEST_TIMEOUT 10800)
endif()

# lintel_cases(TARGET NAME file…): a case of ctest, NAME.FILE, for each file of TARGET's GoogleTest cases. Not one for each of
# them, as most take less time than the start of a program. Where a case skips itself and none fails, ctest says "Skipped".
function(lintel_cases TARGET NAME)
  foreach(file IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(STRINGS ${file} lines REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
    set(filter)
    foreach(line IN LISTS lines)
      if(line MATCHES "^(TYPED_)?TEST(_F|_P)?\\(([A-Za-z0-9]+),")
        list(APPEND filter "${CMAKE_MATCH_3}.*" "*/${CMAKE_MATCH_3}.*" "${CMAKE_MATCH_3}/*")
      endif()
    endforeach()
    if(NOT filter)
      continue()  # a file that helps the others
    endif()
    list(REMOVE_DUPLICATES filter)
    list(JOIN filter ":" filter)
    get_filename_component(case ${file} NAME_WE)
    add_test(NAME ${NAME}.${case} COMMAND ${TARGET} "--gtest_filter=${filter}")
    set_tests_properties(${NAME}.${case} PROPERTIES
      LABELS unit TIMEOUT ${LINTEL_TEST_TIMEOUT} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\] [^\n]*[\n]*$")
  endforeach()
endfunction()

# lintel_room(NAME SOURCES file… [ROOMS room…] [PRIVATE target…] [TESTS file…] [TEST_LINKS target…])
#
# One room: the static library lintel_NAME (alias lintel::NAME) with its public headers in include/lintel/NAME.
# ROOMS are rooms above it in LINTEL_ROOMS; anything else is refused. PRIVATE are third parties.
# TESTS become the executable NAME_tests, every file of them known to ctest. Library and headers are installed, and
# find_package(lintel) makes it lintel::NAME elsewhere, unless LINTEL_ROOMS_NOT_INSTALLED names the room.
function(lintel_room NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;ROOMS;PRIVATE;TESTS;TEST_LINKS" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "lintel_room(${NAME}): unknown arguments ${ARG_UNPARSED_ARGUMENTS}")
  endif()
  list(FIND LINTEL_ROOMS ${NAME} own_place)
  foreach(room IN LISTS ARG_ROOMS)
    list(FIND LINTEL_ROOMS ${room} place)
    if(place LESS 0 OR place GREATER_EQUAL own_place)
      message(FATAL_ERROR "room ${NAME} must not depend on room ${room}: see LINTEL_ROOMS")
    endif()
  endforeach()

  add_library(lintel_${NAME} STATIC ${ARG_SOURCES})
  add_library(lintel::${NAME} ALIAS lintel_${NAME})
  lintel_warnings(lintel_${NAME})
  lintel_unity(lintel_${NAME} 4)
  lintel_precompile(lintel_${NAME} lintel_geometry ${LINTEL_PRECOMPILED})
  target_include_directories(lintel_${NAME} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ARG_ROOMS PREPEND lintel::)
  target_link_libraries(lintel_${NAME} PUBLIC Eigen3::Eigen ${ARG_ROOMS} PRIVATE ${ARG_PRIVATE})

  if(NOT NAME IN_LIST LINTEL_ROOMS_NOT_INSTALLED)
    set_target_properties(lintel_${NAME} PROPERTIES EXPORT_NAME ${NAME})
    install(TARGETS lintel_${NAME} EXPORT lintel COMPONENT development DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY include/lintel TYPE INCLUDE COMPONENT development)
  endif()

  if(BUILD_TESTING AND ARG_TESTS)
    lintel_test_executable(${NAME}_tests ${ARG_TESTS})
    lintel_unity(${NAME}_tests 4)
    target_include_directories(${NAME}_tests PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src ${CMAKE_CURRENT_SOURCE_DIR}/tests)
    target_link_libraries(${NAME}_tests PRIVATE lintel::${NAME} lintel_testing ${ARG_TEST_LINKS})
    lintel_cases(${NAME}_tests ${NAME} ${ARG_TESTS})
  endif()
endfunction()

# What the tests of several rooms need: lintel/testing/TempFolder.h.
add_library(lintel_testing INTERFACE)
target_include_directories(lintel_testing INTERFACE ${CMAKE_CURRENT_LIST_DIR}/core/testing)
include(GoogleTest)
