# SPDX-License-Identifier: BSD-3-Clause
# What is installed beside programs (apps/), libraries and headers (libs/LintelRoom.cmake), man pages and completions
# (doc/): configurations, and what find_package(lintel) reads. Component `development` is what programmers need.
include(CMakePackageConfigHelpers)

install(DIRECTORY share/lintel TYPE DATA
  PATTERN "*.sbatch" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(lintel_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lintel)
list(TRANSFORM LINTEL_LIBRARIES_NEED REPLACE "(.+)" "find_dependency(\\1)" OUTPUT_VARIABLE LINTEL_FIND_DEPENDENCIES)
list(JOIN LINTEL_FIND_DEPENDENCIES "\n" LINTEL_FIND_DEPENDENCIES)
configure_package_config_file(packaging/lintelConfig.cmake.in ${PROJECT_BINARY_DIR}/lintelConfig.cmake
  INSTALL_DESTINATION ${lintel_cmake_folder} NO_SET_AND_CHECK_MACRO)
# before 1.0 a minor version may change the interface
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lintelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lintelConfig.cmake ${PROJECT_BINARY_DIR}/lintelConfigVersion.cmake
  DESTINATION ${lintel_cmake_folder} COMPONENT development)
install(EXPORT lintel NAMESPACE lintel:: FILE lintelTargets.cmake DESTINATION ${lintel_cmake_folder} COMPONENT development)
