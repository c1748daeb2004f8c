// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LimitedMemory.h"

#include "Core/Common/Refuse.h"

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
}
}
