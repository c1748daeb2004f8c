# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Options, and settings of all targets that depend on them.

include(GNUInstallDirs)

option(VOLUMIC_BUILD_PARAVIEW_PLUGIN "Build against ParaView, with its plugin (OFF: against VTK)" OFF)
option(VOLUMIC_BUILD_TESTING "Build the tests" OFF)
option(VOLUMIC_BUILD_EXAMPLES "Build the C++ examples" OFF)
option(VOLUMIC_BUILD_BENCHMARKS "Build the benchmarks" OFF)
option(VOLUMIC_EXTRA_WARNINGS "For developers: let the compiler warn of more than it does by default" OFF)

# Debian's VTK works with Debian's interpreter only. Select it by
# -DPython3_EXECUTABLE=/usr/bin/python3 if another one is the first on PATH.
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
option(VOLUMIC_WRAP_PYTHON "Build the Python package and the command `volumic`" "${Python3_FOUND}")

# Python wrappers cannot be linked to static libraries.
option(BUILD_SHARED_LIBS "Build shared libraries" ON)

get_property(volumic_is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if (NOT CMAKE_BUILD_TYPE AND NOT volumic_is_multi_config)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Kind of build" FORCE)
endif ()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

# Debian packages (VolumicDebian.cmake) are installed into /usr with these paths.
set(volumic_makes_packages OFF)
if (CMAKE_LIBRARY_ARCHITECTURE
    AND CMAKE_INSTALL_LIBDIR STREQUAL "lib/${CMAKE_LIBRARY_ARCHITECTURE}")
  set(volumic_makes_packages ON)
endif ()
# VTK's messages name the source file. Remove the path of the build machine from packages and wheels.
if ((volumic_makes_packages OR SKBUILD) AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  add_compile_options("-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/="
    "-fmacro-prefix-map=${CMAKE_BINARY_DIR}/=")
endif ()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")

# Required VTK components: dependencies of the module and of the wrapper. Tests, examples and benchmarks
# find further ones themselves.
set(volumic_vtk_components
  CommonCore CommonDataModel CommonExecutionModel CommonMath FiltersCore)
if (VOLUMIC_WRAP_PYTHON)
  list(APPEND volumic_vtk_components Python WrappingPythonCore)
endif ()
