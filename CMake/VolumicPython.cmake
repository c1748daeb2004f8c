# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# The Python package `volumic`: VTK's wrapper of the module and an __init__.py that finds it.

find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)

if (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  # pvpython looks in its own folder; ParaView's classes must not meet those of plain VTK.
  set(volumic_python_default "${CMAKE_INSTALL_LIBDIR}/paraview-${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}/python3/site-packages")
else ()
  set(volumic_python_default "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages")
  if (EXISTS "/etc/debian_version")
    set(volumic_python_default "lib/python${Python3_VERSION_MAJOR}/dist-packages")
  endif ()
endif ()
set(VOLUMIC_PYTHON_DESTINATION "${volumic_python_default}" CACHE STRING
  "Where the Python package goes, below the installation prefix")
mark_as_advanced(VOLUMIC_PYTHON_DESTINATION)

# vtk_module_wrap_python puts the wrappers below CMAKE_BINARY_DIR, where __init__.py joins them.
set(volumic_python_build_directory "${CMAKE_BINARY_DIR}/${VOLUMIC_PYTHON_DESTINATION}")

function (volumic_wrap_python)
  # From <python>/volumic up to the prefix, and down to the library.
  file(RELATIVE_PATH up "/prefix/${VOLUMIC_PYTHON_DESTINATION}/volumic" "/prefix/${CMAKE_INSTALL_LIBDIR}")
  set(CMAKE_INSTALL_RPATH "$ORIGIN/${up}")
  vtk_module_wrap_python(
    MODULES ${modules}
    TARGET Volumic::Python
    PYTHON_PACKAGE volumic
    MODULE_DESTINATION "${VOLUMIC_PYTHON_DESTINATION}"
    LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    CMAKE_DESTINATION "${volumic_cmake_destination}"
    SOABI "${Python3_SOABI}"
    INSTALL_HEADERS OFF)
endfunction ()

volumic_wrap_python()

configure_file("${CMAKE_CURRENT_LIST_DIR}/volumic/__init__.py.in"
  "${volumic_python_build_directory}/volumic/__init__.py" @ONLY)
install(FILES "${volumic_python_build_directory}/volumic/__init__.py"
  DESTINATION "${VOLUMIC_PYTHON_DESTINATION}/volumic"
  COMPONENT python)
