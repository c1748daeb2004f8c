// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchMemory_h
#define volumicScratchMemory_h

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace volumic
{
/** What a run may hold in memory, and where the rest goes. */
struct ScratchOptions
{
  /** Resident memory of the process, bytes; 0: no limit, and nothing leaves memory. */
  std::size_t Limit = 0;
  /** Where files are made; empty: TMPDIR, or else /var/tmp. */
  std::string Directory;
};

/** The scratch directory has no room for what is asked for. */
struct ScratchFull : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * While one with a limit is alive, large arrays (LargeVector, AllocateLarge) live in files of the
 * scratch directory, mapped into memory; of their pages as many are resident as the limit allows.
 * The files have no name, so that nothing of them is left behind, however the process ends. Arrays
 * may outlive it. With a limit of 0 it does nothing.
 */
class ScratchMemory
{
public:
  /** @throws std::invalid_argument where the directory cannot be used or the limit kept. */
  explicit ScratchMemory(const ScratchOptions& options);
  ~ScratchMemory();
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Self;
};

/**
 * Memory for an array, zeroed or not: on the heap, or in a file while a limit is set and it is
 * large. @throws std::bad_alloc, ScratchFull.
 */
void* AllocateLarge(std::size_t bytes);
/** Null is nothing. */
void FreeLarge(void* memory) noexcept;
/** It will be needed soon: read ahead what is on disk. Any range; of other memory, nothing. */
void PrefetchLarge(const void* begin, std::size_t bytes);

template <typename T>
struct LargeAllocator
{
  using value_type = T;
  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>&)
  {
  }
  T* allocate(std::size_t n) { return static_cast<T*>(AllocateLarge(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { FreeLarge(memory); }
  template <typename U>
  bool operator==(const LargeAllocator<U>&) const
  {
    return true;
  }
  template <typename U>
  bool operator!=(const LargeAllocator<U>&) const
  {
    return false;
  }
};

/** A vector that may live in scratch memory. */
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;
}

#endif
