// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTemporaryFolder_h
#define volumicTemporaryFolder_h

#include "TestPrelude.h"

#include <filesystem>
#include <stdlib.h>

namespace volumic
{
/** A new folder, which goes with the object. */
class TemporaryFolder
{
public:
  TemporaryFolder() : Name((std::filesystem::temp_directory_path() / "volumic-XXXXXX").string())
  {
    if (!mkdtemp(this->Name.data()))
    {
      throw std::runtime_error("no temporary folder");
    }
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Name, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& Path() const { return this->Name; }

private:
  std::string Name;
};
}

#endif
