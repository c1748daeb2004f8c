# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# What find_package(Volumic) reads: vtk_module_build writes targets and their properties only.

include(CMakePackageConfigHelpers)

set(volumic_vtk_dir "${${VOLUMIC_VTK_PACKAGE}_DIR}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/Volumic-config.cmake.in"
  "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/Volumic-config.cmake"
  INSTALL_DESTINATION "${volumic_cmake_destination}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/Volumic-config-version.cmake"
  VERSION "${Volumic_VERSION}"
  COMPATIBILITY SameMinorVersion)
install(
  FILES
    "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/Volumic-config.cmake"
    "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/Volumic-config-version.cmake"
  DESTINATION "${volumic_cmake_destination}"
  COMPONENT development)
