// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchMemory_h
#define volumicScratchMemory_h

#include <algorithm>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace volumic
{
/** The scratch directory lacks space. */
struct ScratchFull : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * While an object with a directory exists, new large arrays (LargeVector, AllocateLarge) of the
 * process lie in files of that directory, mapped into memory: the kernel writes pages to the disk
 * and reads them as it needs memory. Files have no name, so they vanish with their arrays or with
 * the process, however it ends. Space is reserved beforehand, so that writing to an array cannot
 * fail. Arrays may outlive the object. A forked process shares the arrays with its parent.
 *
 * If several exist, the directory of the last one is used. Any thread may call anything.
 */
class ScratchMemory
{
public:
  /** Smaller arrays are always on the heap. */
  static constexpr std::size_t LargeBytes = std::size_t(1) << 20;

  /**
   * @param directory empty: arrays lie in memory
   * @throws std::invalid_argument if no file can be created there, or the system is not Linux with
   *         64 bits; ScratchFull.
   */
  explicit ScratchMemory(const std::string& directory);
  ~ScratchMemory();
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  /** Return whether new large arrays lie in files. */
  static bool IsUsed();

private:
  std::string Directory;
};

/**
 * Allocate memory for an array. Large arrays are zero, and take no memory before they are written.
 * Smaller ones are on the heap, uninitialized. The address is a multiple of `alignment`, a power of
 * 2 of 64 at most.
 * @throws std::bad_alloc, ScratchFull.
 */
void* AllocateLarge(std::size_t bytes, std::size_t alignment = 64);
/** Free memory that AllocateLarge() has returned for this number of bytes, or null. */
void FreeLarge(void* memory, std::size_t bytes) noexcept;

/**
 * While an object exists, arrays that this thread allocates are zero, and default-constructed
 * values are not written to them. See MakeZeroed().
 */
class ZeroedAllocations
{
public:
  ZeroedAllocations() { ++Alive; }
  ~ZeroedAllocations() { --Alive; }
  ZeroedAllocations(const ZeroedAllocations&) = delete;
  ZeroedAllocations& operator=(const ZeroedAllocations&) = delete;
  /** Return whether an object exists on this thread. */
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
  void deallocate(T* memory, std::size_t n) noexcept { FreeLarge(memory, n * sizeof(T)); }
  /** Write nothing if the memory is zero already. */
  template <typename U>
  void construct(U* slot)
  {
    if (!ZeroedAllocations::AreOn())
    {
      ::new (static_cast<void*>(slot)) U();
    }
  }
  template <typename U, typename First, typename... Others>
  void construct(U* slot, First&& first, Others&&... others)
  {
    ::new (static_cast<void*>(slot)) U(std::forward<First>(first), std::forward<Others>(others)...);
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

/** A vector that may lie in a scratch file. */
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/**
 * Ensure a capacity of n values. A new array is larger, as unused address space costs nothing; in a
 * scratch file, where space is reserved, only by a quarter. Its old values are lost.
 */
template <typename T>
void MakeRoom(LargeVector<T>& values, std::size_t n)
{
  if (values.capacity() < n)
  {
    values = LargeVector<T>();
    values.reserve(ScratchMemory::IsUsed() ? n + n / 4 : 3 * n);
  }
}

/** Replace the values by n zeros, which take no memory before they are written. */
template <typename T>
void MakeZeroed(LargeVector<T>& values, std::size_t n)
{
  values = LargeVector<T>();
  const ZeroedAllocations zeroed;
  values.resize(n);
}

}

#endif
