# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Build the Python package `volumic`: the Python wrapping of the module, the sources of Python/volumic
# and type stubs for editors. The build with VTK adds the command `volumic`, a script.

find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)

if (SKBUILD)
  # The root of a wheel is the folder of Python packages.
  set(volumic_python_default ".")
elseif (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  # pvpython searches its own folder. Classes of ParaView's VTK and of plain VTK must not be mixed.
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

# vtk_module_wrap_python puts the wrappers below CMAKE_BINARY_DIR. The sources are copied there, so the
# package and the command also work in the build tree.
set(volumic_python_sources "${CMAKE_SOURCE_DIR}/Python/volumic")
set(volumic_python_build_directory "${CMAKE_BINARY_DIR}/${VOLUMIC_PYTHON_DESTINATION}")
set(volumic_python_package "${volumic_python_build_directory}/volumic")

function (volumic_wrap_python)
  # From <python>/volumic to the library, by way of the prefix.
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

# Advice in the message if the package does not find the VTK that it was built for.
if (VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  set(volumic_python_hint "Use ParaView's pvpython or pvbatch; install python3-paraview where it is missing.")
else ()
  set(volumic_python_hint "Use /usr/bin/python3, or python3 -m venv --system-site-packages.")
  if (NOT EXISTS "/etc/debian_version")
    set(volumic_python_hint "Use the Python of that VTK.")
  endif ()
endif ()
if (NOT DEFINED volumic_vtk_version) # VolumicWheel.cmake requires more
  set(volumic_vtk_version "${VTK_MAJOR_VERSION}.${VTK_MINOR_VERSION}")
  set(volumic_vtk_folder "")
endif ()
configure_file("${volumic_python_sources}/__init__.py.in" "${volumic_python_package}/__init__.py"
  @ONLY)
install(FILES "${volumic_python_package}/__init__.py"
  DESTINATION "${VOLUMIC_PYTHON_DESTINATION}/volumic"
  COMPONENT python)
file(GLOB_RECURSE volumic_python_files RELATIVE "${volumic_python_sources}" CONFIGURE_DEPENDS
  "${volumic_python_sources}/*.py")
foreach (file IN LISTS volumic_python_files)
  configure_file("${volumic_python_sources}/${file}" "${volumic_python_package}/${file}" COPYONLY)
endforeach ()
install(DIRECTORY "${volumic_python_sources}/"
  DESTINATION "${VOLUMIC_PYTHON_DESTINATION}/volumic"
  COMPONENT python
  FILES_MATCHING PATTERN "*.py"
  PATTERN __pycache__ EXCLUDE)

# pip creates the command of a wheel (pyproject.toml). A ParaView plugin has no command.
if (NOT SKBUILD AND NOT VOLUMIC_BUILD_PARAVIEW_PLUGIN)
  file(RELATIVE_PATH volumic_command_to_package
    "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${VOLUMIC_PYTHON_DESTINATION}")
  configure_file("${CMAKE_CURRENT_LIST_DIR}/volumic.in"
    "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/volumic" @ONLY)
  install(PROGRAMS "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/volumic"
    DESTINATION "${CMAKE_INSTALL_BINDIR}"
    COMPONENT python)
endif ()

# The built package writes the stubs, and must find VTK's Python package. -S: without the module `site`,
# by which pip hides the packages of the system during a build.
set(volumic_stubs_path "${volumic_python_build_directory}" "${VTK_PREFIX_PATH}/${VTK_PYTHONPATH}")
if (DEFINED ENV{PYTHONPATH})
  list(APPEND volumic_stubs_path "$ENV{PYTHONPATH}")
endif ()
list(JOIN volumic_stubs_path ":" volumic_stubs_path)
set(volumic_stubs_command "${CMAKE_COMMAND}" -E env "PYTHONPATH=${volumic_stubs_path}"
  "PYTHONDONTWRITEBYTECODE=1" "${Python3_EXECUTABLE}" -S)

# True if this machine can run the programs that it builds.
set(volumic_stubs_obstacle "")
if (CMAKE_CROSSCOMPILING)
  set(volumic_stubs_obstacle "cross-compiling")
else ()
  execute_process(COMMAND ${volumic_stubs_command} -c "import vtkmodules.vtkCommonExecutionModel"
    RESULT_VARIABLE volumic_stubs_status OUTPUT_QUIET ERROR_QUIET)
  if (NOT volumic_stubs_status EQUAL 0)
    set(volumic_stubs_obstacle "${Python3_EXECUTABLE} does not find VTK's package vtkmodules")
  endif ()
endif ()

if (volumic_stubs_obstacle)
  message(STATUS "No type stubs of the Python package: ${volumic_stubs_obstacle}")
else ()
  set(volumic_stubs "${volumic_python_package}/vtkFiltersVolumic.pyi"
    "${volumic_python_package}/__init__.pyi" "${volumic_python_package}/py.typed")
  set(volumic_wrapper vtkFiltersVolumicPython)
  if (TARGET "Py${volumic_wrapper}") # from VTK 9.7 on
    string(PREPEND volumic_wrapper "Py")
  endif ()
  set(volumic_stubs_script "${CMAKE_CURRENT_LIST_DIR}/write_stubs.py")
  add_custom_command(OUTPUT ${volumic_stubs}
    COMMAND ${volumic_stubs_command} "${volumic_stubs_script}" "${volumic_python_package}"
    DEPENDS "${volumic_stubs_script}" "${volumic_wrapper}"
      "${volumic_python_sources}/__init__.py.in"
    COMMENT "Writing the type stubs of the Python package"
    VERBATIM)
  add_custom_target(VolumicPythonStubs ALL DEPENDS ${volumic_stubs})
  install(FILES ${volumic_stubs}
    DESTINATION "${VOLUMIC_PYTHON_DESTINATION}/volumic"
    COMPONENT python)
endif ()
