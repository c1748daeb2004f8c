# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Build the VTK module Volumic::FiltersVolumic for VTK or ParaView.

# Both flavours can be installed under one prefix. Names of files for ParaView have a suffix, as those
# of Debian's libraries.
if (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  set(volumic_flavour "pv${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}")
  set(volumic_flavour_suffix "-${volumic_flavour}")
else ()
  set(volumic_flavour "")
  set(volumic_flavour_suffix "")
endif ()
set(volumic_cmake_destination "${CMAKE_INSTALL_LIBDIR}/cmake/Volumic${volumic_flavour_suffix}")

# Installed files find each other after the prefix is moved, and VTK where CMake found it.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)

function (volumic_build_module)
  vtk_module_scan(
    MODULE_FILES "${CMAKE_SOURCE_DIR}/vtk.module"
    REQUEST_MODULES Volumic::FiltersVolumic
    PROVIDES_MODULES modules
    HIDE_MODULES_FROM_CACHE ON
    ENABLE_TESTS OFF)
  # The folder of vtk.module is the root, so the module needs another binary folder than the project.
  set(version VERSION "${Volumic_VERSION}" SOVERSION "${Volumic_VERSION_MAJOR}")
  if (SKBUILD)
    set(version "") # a wheel has no links, so the library has one name only
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
