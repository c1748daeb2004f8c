// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"

#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchFile.h"
#include "Core/Common/ScratchStore.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

namespace volumic
{
namespace
{
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

/** Memory that is zero and not there before it is written: its bytes, by address. */
class ZeroedMemory
{
public:
  static ZeroedMemory& Instance()
  {
    static ZeroedMemory* const memory = new ZeroedMemory; // Never ends, as ScratchStore.
    return *memory;
  }

  void* Allocate(std::size_t bytes)
  {
    void* memory = MapZeroed(bytes);
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Arrays.emplace(memory, bytes);
    this->Count = this->Arrays.size();
    return memory;
  }

  /** @return whether it was such memory. */
  bool Free(void* memory) noexcept
  {
    if (this->Count.load(std::memory_order_acquire) == 0)
    {
      return false;
    }
    std::size_t bytes = 0;
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      const auto found = this->Arrays.find(memory);
      if (found == this->Arrays.end())
      {
        return false;
      }
      bytes = found->second;
      this->Arrays.erase(found);
      this->Count = this->Arrays.size();
    }
    UnmapScratchFile(memory, bytes);
    return true;
  }

private:
  std::mutex Mutex;
  std::map<void*, std::size_t> Arrays;
  std::atomic<std::size_t> Count{ 0 };
};

void* AllocateZeroed(std::size_t bytes, std::size_t alignment)
{
  if (ScratchIsPossible && bytes >= ScratchMemory::LargeBytes)
  {
    return ZeroedMemory::Instance().Allocate(bytes);
  }
  void* memory = AllocateOnHeap(bytes, alignment);
  std::memset(memory, 0, bytes);
  return memory;
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
    Refuse("Memory Limit is ", Mebibytes(options.Limit), " MiB, but memory can only be limited on "
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
    warnings.push_back(Join("Scratch Directory ", options.Directory, " is memory itself (tmpfs): "
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
  if (bytes >= ScratchMemory::LargeBytes && ScratchStore::Instance().HasLimit())
  {
    if (void* memory = ScratchStore::Instance().Map(bytes))
    {
      return memory; // Files begin as zeros.
    }
  }
  return ZeroedAllocations::AreOn() || bytes >= ScratchMemory::LargeBytes
    ? AllocateZeroed(bytes, alignment)
    : AllocateOnHeap(bytes, alignment);
}

void FreeLarge(void* memory) noexcept
{
  if (memory && !ScratchStore::Instance().Unmap(memory) &&
    !ZeroedMemory::Instance().Free(memory))
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
    ScratchStore::Instance().Prefetch(begin, bytes);
  }
}
}
