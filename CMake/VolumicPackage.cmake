# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Package files for find_package(Volumic). vtk_module_build writes only targets and their properties.

include(CMakePackageConfigHelpers)

set(volumic_vtk_dir "${${VOLUMIC_VTK_PACKAGE}_DIR}")
# ParaView is found as a whole, VTK by the modules that are needed.
set(volumic_dependency_components "")
if (NOT VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  list(JOIN volumic_vtk_components " " volumic_dependency_components)
  string(PREPEND volumic_dependency_components "COMPONENTS ")
endif ()
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/VolumicConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/VolumicConfig.cmake"
  INSTALL_DESTINATION "${volumic_cmake_destination}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/VolumicConfigVersion.cmake"
  VERSION "${Volumic_VERSION}"
  COMPATIBILITY SameMinorVersion)
install(
  FILES
    "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/VolumicConfig.cmake"
    "${CMAKE_BINARY_DIR}/${volumic_cmake_destination}/VolumicConfigVersion.cmake"
  DESTINATION "${volumic_cmake_destination}"
  COMPONENT development)
