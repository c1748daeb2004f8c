# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# What differs when `pip install` builds (see pyproject.toml; scikit-build-core sets SKBUILD): the
# library lies in the folder of the Python package, and the program where pip puts programs.

set(CMAKE_INSTALL_LIBDIR volumic)
set(VOLUMIC_WRAP_PYTHON ON)
set(volumic_tool_destination "${SKBUILD_SCRIPTS_DIR}")
set(volumic_manual_destination "${SKBUILD_DATA_DIR}/share/man/man1")

# pip shows the end of CMake's output only: a message of our own, with the way out.
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
find_package(VTK 9.1 QUIET COMPONENTS Python WrappingPythonCore)
set(missing "")
if (NOT Python3_FOUND OR NOT EXISTS "${Python3_INCLUDE_DIR}/Python.h")
  string(APPEND missing "\n  the header files of ${Python3_EXECUTABLE} (Debian: libpython3-dev)")
endif ()
if (NOT VTK_FOUND)
  string(APPEND missing "\n  VTK 9.1 or later, with its header files, CMake files and Python "
    "package (Debian: libvtk9-dev python3-vtk9)")
endif ()
find_package(nlohmann_json 3.9 QUIET)
if (NOT nlohmann_json_FOUND)
  string(APPEND missing "\n  nlohmann_json 3.9 (Debian: nlohmann-json3-dev)")
endif ()
find_package(LibArchive QUIET)
if (NOT LibArchive_FOUND)
  string(APPEND missing "\n  libarchive (Debian: libarchive-dev)")
endif ()
if (missing)
  message(FATAL_ERROR "volumic is compiled for the VTK of this machine, and here is missing:"
    "${missing}\nWhere VTK is elsewhere, tell pip:\n"
    "  --config-settings=cmake.define.VTK_DIR=<lib/cmake/vtk-...>\n"
    "${VTK_NOT_FOUND_MESSAGE}")
endif ()

# From the program to the library, wherever pip puts the two: in an environment or a home; on
# Debian, for all users; with --target.
set(volumic_python_folder "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}")
set(volumic_tool_rpath
  "$ORIGIN/../${volumic_python_folder}/site-packages/volumic"
  "$ORIGIN/../${volumic_python_folder}/dist-packages/volumic"
  "$ORIGIN/../volumic")
