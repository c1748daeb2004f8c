# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Settings of a build by `pip install` (see pyproject.toml; scikit-build-core sets SKBUILD): the library is
# in the folder of the Python package.

set(CMAKE_INSTALL_LIBDIR volumic)
set(VOLUMIC_WRAP_PYTHON ON)

# pip shows only the end of CMake's output. Print a message that says what to do.
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
find_package(VTK 9.1 QUIET COMPONENTS Python WrappingPythonCore)
find_package(TBB QUIET)
set(missing "")
if (NOT Python3_FOUND OR NOT EXISTS "${Python3_INCLUDE_DIR}/Python.h")
  string(APPEND missing "\n  the header files of ${Python3_EXECUTABLE} (Debian: libpython3-dev)")
endif ()
if (NOT VTK_FOUND)
  string(APPEND missing "\n  VTK 9.1 or later, with its header files, CMake files and Python "
    "package (Debian: libvtk9-dev python3-vtk9)")
endif ()
if (NOT TBB_FOUND)
  string(APPEND missing "\n  oneTBB, with its header files (Debian: libtbb-dev)")
endif ()
if (missing)
  message(FATAL_ERROR "volumic is compiled for the VTK of this machine. Missing:"
    "${missing}\nWhere VTK is elsewhere, give pip the option\n"
    "  --config-settings=cmake.define.VTK_DIR=<lib/cmake/vtk-...>\n"
    "${VTK_NOT_FOUND_MESSAGE}")
endif ()

# A wheel works only with the VTK that it was compiled for. The package checks that when it is
# imported (Python/volumic/__init__.py.in). pip checks it as well where it lists VTK as the
# distribution `vtk`, which it does not on Debian 12 and 13.
set(volumic_vtk_version "${VTK_VERSION}")
set(packages "${VTK_PREFIX_PATH}/${VTK_PYTHONPATH}")
get_filename_component(volumic_vtk_folder "${packages}/vtkmodules" REALPATH)
if (DEFINED ENV{VOLUMIC_WHEEL_REQUIREMENT} AND EXISTS "${packages}/vtk-${VTK_VERSION}.dist-info")
  file(WRITE "$ENV{VOLUMIC_WHEEL_REQUIREMENT}" "vtk==${VTK_VERSION}")
endif ()
