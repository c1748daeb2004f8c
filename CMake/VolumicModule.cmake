# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Build the VTK module Volumic::FiltersVolumic for VTK or ParaView.

# Both variants can be installed under one prefix: names for ParaView have a suffix, as Debian's libraries.
if (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  set(volumic_flavour "pv${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}")
  set(volumic_flavour_suffix "-${volumic_flavour}")
else ()
  set(volumic_flavour "")
  set(volumic_flavour_suffix "")
endif ()
set(volumic_cmake_destination "${CMAKE_INSTALL_LIBDIR}/cmake/Volumic${volumic_flavour_suffix}")

# Installed libraries find VTK in the folder where CMake found it, and each other by $ORIGIN.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)

function (volumic_build_module)
  vtk_module_scan(
    MODULE_FILES "${CMAKE_SOURCE_DIR}/vtk.module"
    REQUEST_MODULES Volumic::FiltersVolumic
    PROVIDES_MODULES modules
    HIDE_MODULES_FROM_CACHE ON
    ENABLE_TESTS OFF)
  # vtk.module is in the top folder of the project. Use another binary folder than that of the project,
  # within this function.
  set(version VERSION "${Volumic_VERSION}" SOVERSION "${Volumic_VERSION_MAJOR}")
  if (SKBUILD)
    set(version "") # a wheel has no symbolic links, so the library has one name
  endif ()
  list(PREPEND CMAKE_INSTALL_RPATH "$ORIGIN")
  set(CMAKE_BINARY_DIR "${CMAKE_BINARY_DIR}/module")
  vtk_module_build(
    MODULES ${modules}
    PACKAGE Volumic
    INSTALL_EXPORT Volumic
    LIBRARY_NAME_SUFFIX "${volumic_flavour}"
    ${version}
    ENABLE_WRAPPING ON
    HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/volumic"
    LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    ARCHIVE_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    RUNTIME_DESTINATION "${CMAKE_INSTALL_BINDIR}"
    CMAKE_DESTINATION "${volumic_cmake_destination}"
    HIERARCHY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/vtk/hierarchy/Volumic${volumic_flavour_suffix}")
  set(modules "${modules}" PARENT_SCOPE)
endfunction ()

volumic_build_module()

# VTK installs the LICENSE_FILES of vtk.module from version 9.2 on.
if (VTK_VERSION VERSION_LESS 9.2)
  install(FILES "${CMAKE_SOURCE_DIR}/LICENSE"
    DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/Volumic/vtkFiltersVolumic"
    COMPONENT licenses)
endif ()
