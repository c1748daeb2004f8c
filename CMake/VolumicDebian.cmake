# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Debian packages, made by `cpack` in the build tree:
#   with VTK       volumic (command, Python package and library), volumic-dev
#   with ParaView  paraview-volumic (plugin, its library and Python package)
# No package contains the headers and CMake files for ParaView's VTK: their paths are those of
# volumic-dev.

if (NOT volumic_makes_packages)
  message(STATUS "No Debian packages: they need -DCMAKE_INSTALL_LIBDIR="
    "lib/${CMAKE_LIBRARY_ARCHITECTURE} (or -DCMAKE_INSTALL_PREFIX=/usr)")
  return ()
endif ()

set(VOLUMIC_PACKAGE_MAINTAINER "Volumic contributors <volumic@users.noreply.invalid>" CACHE STRING
  "Maintainer of the Debian packages: name and address")
mark_as_advanced(VOLUMIC_PACKAGE_MAINTAINER)

set(volumic_debian "${CMAKE_CURRENT_LIST_DIR}/debian")
set(volumic_debian_revision 1)
set(volumic_debian_version "${Volumic_VERSION}-${volumic_debian_revision}")
string(TIMESTAMP volumic_debian_date "%a, %d %b %Y %H:%M:%S +0000" UTC)

# volumic_describe_package(COMPONENT PACKAGE SECTION SUMMARY): set the description of a package, and
# install its copyright and changelog.
function (volumic_describe_package component package section summary)
  set(changelog "${CMAKE_BINARY_DIR}/debian/${package}/changelog.Debian")
  configure_file("${volumic_debian}/changelog.in" "${changelog}" @ONLY)
  install(FILES "${volumic_debian}/copyright" "${changelog}"
    DESTINATION "share/doc/${package}"
    COMPONENT "${component}"
    EXCLUDE_FROM_ALL)
  string(TOUPPER "${component}" upper)
  set(prefix "CPACK_DEBIAN_${upper}")
  set("${prefix}_PACKAGE_NAME" "${package}" PARENT_SCOPE)
  set("${prefix}_PACKAGE_SECTION" "${section}" PARENT_SCOPE)
  file(READ "${volumic_debian}/description.txt" common)
  file(READ "${volumic_debian}/description-${package}.txt" own)
  string(STRIP "${summary}\n${common}${own}" description)
  set("${prefix}_DESCRIPTION" "${description}" PARENT_SCOPE)
endfunction ()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME volumic)
set(CPACK_PACKAGE_VENDOR "Volumic contributors")
# The summary of a package is the first line of its description.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGE_CONTACT "${VOLUMIC_PACKAGE_MAINTAINER}")
set(CPACK_PACKAGE_VERSION "${Volumic_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE "${CMAKE_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS "${volumic_debian}/PrepareTree.cmake")
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE "${volumic_debian_revision}")
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Dependencies on the packages of libraries. Our own libraries are in the build and named below.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")

# An extension module works with one version of Python.
math(EXPR volumic_next_python "${Python3_VERSION_MINOR} + 1")
set(volumic_python_dependency
  "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${volumic_next_python})")

# Imported when a file that needs them is read or written. tetgen and gmsh are programs.
set(volumic_python_recommends "python3-scipy, python3-nibabel, python3-pydicom, python3-gdcm"
  "python3-tifffile, python3-mrcfile, python3-zarr, python3-h5py, python3-meshio, python3-pil")
list(JOIN volumic_python_recommends ", " volumic_python_recommends)

# One package for everything except development files.
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL runtime)
# Register the library with the linker and other packages.
set(control library-shlibs.in library-triggers.in)
if (VOLUMIC_WRAP_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  # Byte-compile at installation; remove the files at removal.
  list(APPEND control python-postinst.in python-prerm.in)
endif ()
if (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  list(APPEND CPACK_COMPONENTS_ALL plugin)
  set(group plugin)
  set(package paraview-volumic)
  set(CPACK_DEBIAN_PLUGIN_PACKAGE_RECOMMENDS
    "python3-paraview, python3-numpy, ${volumic_python_recommends}")
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${VOLUMIC_PLUGIN_DIR}")
  volumic_describe_package(plugin paraview-volumic science
    "closed surfaces from 3D images, plugin for ParaView")
else ()
  set(group runtime)
  set(package volumic)
  if (VOLUMIC_WRAP_PYTHON)
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS
      "python3-vtk9, python3-numpy, ${volumic_python_dependency}")
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "${volumic_python_recommends}")
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS
      "tetgen, gmsh, draco, python3-distributed, python3-argcomplete")
    # Former package of the Python package.
    foreach (field IN ITEMS PROVIDES CONFLICTS REPLACES)
      set("CPACK_DEBIAN_RUNTIME_PACKAGE_${field}" python3-volumic)
    endforeach ()
  endif ()
  volumic_describe_package(runtime volumic science
    "closed surfaces from 3D images, command and Python package")
  volumic_describe_package(development volumic-dev libdevel
    "closed surfaces from 3D images, development files")
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "volumic (= ${volumic_debian_version}), libvtk9-dev (>= 9.1)")
endif ()
string(TOUPPER "${group}" upper)
foreach (template IN LISTS control)
  string(REGEX REPLACE "^(python|library)-(.*)[.]in$" "\\2" name "${template}")
  set(file "${CMAKE_BINARY_DIR}/debian/${package}/${name}")
  configure_file("${volumic_debian}/${template}" "${file}" @ONLY)
  list(APPEND "CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA" "${file}")
endforeach ()
foreach (component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" upper)
  set("CPACK_COMPONENT_${upper}_GROUP" "${group}")
endforeach ()
if (NOT VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  list(APPEND CPACK_COMPONENTS_ALL development)
  set(CPACK_COMPONENT_DEVELOPMENT_GROUP development)
endif ()

include(CPack)
