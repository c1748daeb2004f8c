// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchMemory_h
#define volumicScratchMemory_h

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
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

struct ScratchLimit;

/** What became of a limit since it was set; all in bytes. */
struct ScratchStatistics
{
  std::size_t MostResident = 0;  ///< The most memory that the whole process has had.
  std::size_t MostAnonymous = 0; ///< The most of it that no file held, and that could not leave.
  std::size_t Mapped = 0;        ///< What arrays in files take now.
  std::size_t Dropped = 0;       ///< What was taken out of memory, counted again each time.
};

/**
 * While one with a limit is alive, large arrays (LargeVector, AllocateLarge) live in files of the
 * scratch directory, mapped into memory; of their pages as many are resident as the limit allows.
 * The files have no name, so that nothing of them is left behind, however the process ends. Arrays
 * may outlive it. With a limit of 0 it does nothing.
 *
 * The limit is that of the process. Where several are alive, the smallest limit counts, and new
 * arrays go to the directory of the last one. A thread looks at the resident memory of the
 * process every few ms, and so do threads that work (KeepMemoryLimit); they drop pages from 3/5
 * of it on, or from 1 GiB below it, one array after another, round and round; the system keeps
 * them in its cache while it can, so that most come back without the disk.
 * What is no large array cannot be dropped: where that alone passes the limit, or threads fill it
 * faster than it is emptied, the run goes on beyond it, and Warnings() says so.
 *
 * A process that is forked off can read the arrays, and free them, but not write them, which its
 * parent would see; its own are on the heap until it sets a limit itself.
 */
class ScratchMemory
{
public:
  /** Arrays of fewer bytes are on the heap in any case. */
  static constexpr std::size_t LargeBytes = std::size_t(1) << 20;
  /** What a limit must at least leave beyond that which cannot be dropped when it is set. */
  static constexpr std::size_t LeastBytes = std::size_t(128) << 20;

  /**
   * @throws std::invalid_argument where the directory cannot be used, or the limit not be kept, or
   *         the system has no such memory (Linux of 64 bits has); ScratchFull.
   */
  explicit ScratchMemory(const ScratchOptions& options);
  ~ScratchMemory();
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  ScratchStatistics Statistics() const;
  /** What the user should know by now, a sentence or two each: of the directory, and the limit. */
  std::vector<std::string> Warnings() const;

private:
  std::unique_ptr<ScratchLimit> Self; ///< Null: no limit.
};

/**
 * Memory for an array. Where it is large, it is zero, and takes none before it is written; while a
 * limit is set it is in a file. Otherwise it is on the heap, with any content. The address is a
 * multiple of `alignment`, a power of 2 of 64 at most.
 * @throws std::bad_alloc, ScratchFull.
 */
void* AllocateLarge(std::size_t bytes, std::size_t alignment = 64);
/** Null is nothing. */
void FreeLarge(void* memory) noexcept;
/** It will be needed soon: room is made below the limit, and what is on disk is read ahead. */
void PrefetchLarge(const void* begin, std::size_t bytes);

/** Whether a limit is set, by anyone. */
bool HasMemoryLimit();
/**
 * For threads that go through much memory, every few MB: drops pages where it is time to, as the
 * governor's turn may come late on a busy machine. Nothing without a limit.
 */
void KeepMemoryLimit();

/**
 * While one is alive, arrays that this thread allocates are all zero, and the values that it adds
 * to them are not written: those of an array that is new. See MakeZeroed.
 */
class ZeroedAllocations
{
public:
  ZeroedAllocations() { ++Alive; }
  ~ZeroedAllocations() { --Alive; }
  ZeroedAllocations(const ZeroedAllocations&) = delete;
  ZeroedAllocations& operator=(const ZeroedAllocations&) = delete;
  /** Asked for each value of an array. */
  static bool AreOn() { return Alive > 0; }

private:
  inline static thread_local int Alive = 0;
};

template <typename T>
struct LargeAllocator
{
  using value_type = T;
  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>&)
  {
  }
  T* allocate(std::size_t n) { return static_cast<T*>(AllocateLarge(n * sizeof(T), alignof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { FreeLarge(memory); }
  /** Writes nothing where the memory is zero already. */
  template <typename U>
  void construct(U* place)
  {
    if (!ZeroedAllocations::AreOn())
    {
      ::new (static_cast<void*>(place)) U();
    }
  }
  template <typename U, typename First, typename... Others>
  void construct(U* place, First&& first, Others&&... others)
  {
    ::new (static_cast<void*>(place))
      U(std::forward<First>(first), std::forward<Others>(others)...);
  }
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

/**
 * Empties it where it has no room for n values, and gives it room for more: address space costs
 * nothing where no limit is set, and new pages take longer than all that is done with them; in a
 * file room is counted.
 */
template <typename T>
void MakeRoom(LargeVector<T>& values, std::size_t n)
{
  if (values.capacity() < n)
  {
    values = LargeVector<T>();
    values.reserve(HasMemoryLimit() ? n + n / 4 : 3 * n);
  }
}

/** Makes it n values of bytes that are all zero, which take no memory before they are written. */
template <typename T>
void MakeZeroed(LargeVector<T>& values, std::size_t n)
{
  values = LargeVector<T>();
  const ZeroedAllocations zeroed;
  values.resize(n);
}

}

#endif
