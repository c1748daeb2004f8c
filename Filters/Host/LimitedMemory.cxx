// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/LimitedMemory.h"

#include "Core/Common/Refuse.h"

#include <algorithm>

namespace volumic
{
LimitedMemory::LimitedMemory() = default;
LimitedMemory::~LimitedMemory() = default;

void LimitedMemory::Set(int mebibytes, const std::string& directory)
{
  if (mebibytes < 0)
  {
    Refuse("Memory Limit is ", mebibytes, "; it must be 0 (none) or a number of MiB.");
  }
  ScratchOptions wanted;
  wanted.Limit = BytesOf(mebibytes);
  wanted.Directory = directory;
  if (wanted.Limit == this->Options.Limit && wanted.Directory == this->Options.Directory)
  {
    return;
  }
  this->Scratch.reset();
  this->Options = ScratchOptions();
  if (wanted.Limit > 0)
  {
    this->Scratch = std::make_unique<ScratchMemory>(wanted);
    this->Options = wanted;
  }
  this->Told.clear();
}

std::vector<std::string> LimitedMemory::TakeWarnings()
{
  std::vector<std::string> warnings;
  for (const std::string& text : this->Scratch ? this->Scratch->Warnings() : warnings)
  {
    if (std::find(this->Told.begin(), this->Told.end(), text) == this->Told.end())
    {
      warnings.push_back(text);
      this->Told.push_back(text);
    }
  }
  return warnings;
}
}
