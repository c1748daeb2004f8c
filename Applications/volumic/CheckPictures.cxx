// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// PNG (W3C recommendation).
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <string>

namespace tool
{
namespace
{
/** A chain of chunks, each with its checksum. */
void CheckPng(const std::string& name)
{
  BinaryFile file(name);
  file.IsBig = true;
  const std::string mark = "\x89PNG\r\n\x1a\n";
  if (file.Size() < mark.size() || file.Text(0, mark.size()) != mark)
  {
    return;
  }
  std::string kind;
  for (std::uint64_t at = mark.size(); kind != "IEND";)
  {
    const std::uint64_t length = file.Number(at, 4);
    const std::string chunk = file.Text(at + 4, length + 4);
    const uLong sum = crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(chunk.data()),
      static_cast<uInt>(chunk.size()));
    if (sum != file.Number(at + 8 + length, 4))
    {
      throw Failure("the file is damaged: the checksum of its part at byte " + std::to_string(at) +
        " is wrong; copy it again");
    }
    kind = chunk.substr(0, 4);
    at += 12 + length;
  }
}
}

int CheckPicture(const std::string& name)
{
  CheckPng(name);
  return std::max(CheckTiff(name), 1);
}
}
