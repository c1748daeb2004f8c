// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"

#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchFile.h"
#include "Core/Common/ScratchStore.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

namespace volumic
{
namespace
{
#ifdef __SANITIZE_ADDRESS__
// It guards what is about an array of the heap, not what is about a mapping.
constexpr bool HeapIsGuarded = true;
#else
constexpr bool HeapIsGuarded = false;
#endif

void* AllocateOnHeap(std::size_t bytes, std::size_t alignment)
{
#ifdef _WIN32
  void* memory = _aligned_malloc(bytes, alignment);
#else
  const std::size_t least = std::max(alignment, alignof(std::max_align_t));
  void* memory = least == alignof(std::max_align_t)
    ? std::malloc(bytes)
    : std::aligned_alloc(least, (bytes + least - 1) / least * least);
#endif
  if (!memory && bytes > 0)
  {
    throw std::bad_alloc();
  }
  return memory;
}

void FreeOnHeap(void* memory) noexcept
{
#ifdef _WIN32
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

}

ScratchMemory::ScratchMemory(const ScratchOptions& options)
{
  if (options.Limit == 0)
  {
    return;
  }
  if (!ScratchIsPossible)
  {
    Refuse("Memory Limit is ", Mebibytes(options.Limit),
      " MiB, but memory can only be limited on "
      "Linux of 64 bits. Set it to 0, which is no limit.");
  }
  auto self = std::make_unique<ScratchLimit>();
  self->Options = options;
  self->Options.Directory = CheckedScratchDirectory(options.Directory);
  self->DirectoryIsMemory = IsMemory(self->Options.Directory);
  ScratchStore::Instance().Add(*self);
  this->Self = std::move(self);
}

ScratchMemory::~ScratchMemory()
{
  if (this->Self)
  {
    ScratchStore::Instance().Remove(*this->Self);
  }
}

ScratchStatistics ScratchMemory::Statistics() const
{
  return this->Self ? ScratchStore::Instance().StatisticsOf(*this->Self) : ScratchStatistics();
}

std::vector<std::string> ScratchMemory::Warnings() const
{
  std::vector<std::string> warnings;
  if (!this->Self)
  {
    return warnings;
  }
  const ScratchOptions& options = this->Self->Options;
  if (this->Self->DirectoryIsMemory)
  {
    warnings.push_back(Join("Scratch Directory ", options.Directory,
      " is memory itself (tmpfs): "
      "what is put there still takes memory. Choose one on a disk."));
  }
  const ScratchStatistics statistics = this->Statistics();
  if (statistics.MostResident > options.Limit)
  {
    warnings.push_back(Join("Memory Limit is ", Mebibytes(options.Limit), " MiB, but up to ",
      Mebibytes(statistics.MostResident), " MiB were resident, of which ",
      Mebibytes(statistics.MostAnonymous), " MiB cannot be put into files."));
  }
  return warnings;
}

void* AllocateLarge(std::size_t bytes, std::size_t alignment)
{
  const bool isLarge = bytes >= ScratchMemory::LargeBytes;
  if (ScratchIsPossible && isLarge && (!HeapIsGuarded || HasMemoryLimit()))
  {
    return ScratchStore::Instance().Map(bytes);
  }
  void* memory = AllocateOnHeap(bytes, alignment);
  if (isLarge || ZeroedAllocations::AreOn())
  {
    std::memset(memory, 0, bytes);
  }
  return memory;
}

void FreeLarge(void* memory) noexcept
{
  if (memory && !ScratchStore::Instance().Unmap(memory))
  {
    FreeOnHeap(memory);
  }
}

bool HasMemoryLimit()
{
  return ScratchStore::Instance().HasLimit();
}

void KeepMemoryLimit()
{
  if (ScratchStore::Instance().HasLimit())
  {
    ScratchStore::Instance().KeepIfDue();
  }
}

void PrefetchLarge(const void* begin, std::size_t bytes)
{
  if (ScratchStore::Instance().HasLimit())
  {
    ScratchStore::Instance().KeepIfDue();
    ReadPagesAhead(begin, bytes);
  }
}
}
