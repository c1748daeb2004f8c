// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"

#include <cstdlib>
#include <new>

namespace volumic
{
struct ScratchMemory::Implementation
{
};

ScratchMemory::ScratchMemory(const ScratchOptions&)
{
}

ScratchMemory::~ScratchMemory() = default;

void* AllocateLarge(std::size_t bytes)
{
  void* memory = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!memory && bytes > 0)
  {
    throw std::bad_alloc();
  }
  return memory;
}

void FreeLarge(void* memory) noexcept
{
  std::free(memory);
}

void PrefetchLarge(const void*, std::size_t)
{
}
}
