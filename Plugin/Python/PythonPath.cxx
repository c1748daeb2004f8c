// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PythonPath.h"

#include <vtkPythonInterpreter.h>

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace volumic
{
//------------------------------------------------------------------------------
void AddPythonPath()
{
  Dl_info library;
  if (dladdr(reinterpret_cast<void*>(&AddPythonPath), &library) == 0)
  {
    return;
  }
  // The prefix of the installation or build is a parent of the folder of the plugin.
  std::error_code error;
  std::filesystem::path folder = std::filesystem::canonical(library.dli_fname, error);
  while (folder.has_relative_path())
  {
    folder = folder.parent_path();
    const std::filesystem::path packages = folder / VOLUMIC_PYTHON_DESTINATION;
    if (std::filesystem::exists(packages / "volumic_paraview.py", error))
    {
      vtkPythonInterpreter::PrependPythonPath(packages.c_str());
      return;
    }
  }
}
}
