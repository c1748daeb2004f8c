// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchStore_h
#define volumicScratchStore_h

#include "Core/Common/ScratchFile.h"
#include "Core/Common/ScratchMemory.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace volumic
{
/** What is known of a limit that is set. */
struct ScratchLimit
{
  ScratchOptions Options;
  ScratchStatistics Statistics;
  bool DirectoryIsMemory = false;
};

/**
 * All large arrays, and all limits of the process; what ScratchMemory and its functions do is done
 * here. Any thread may call anything.
 */
class ScratchStore
{
public:
  /** Never ends: arrays may be freed at the very end of the process. */
  static ScratchStore& Instance()
  {
    static ScratchStore* const store = new ScratchStore;
    return *store;
  }

  /** @throws std::invalid_argument where it is less than what the process holds. */
  void Add(ScratchLimit& limit);
  void Remove(ScratchLimit& limit);
  ScratchStatistics StatisticsOf(const ScratchLimit& limit);

  bool HasLimit() const { return this->NumberOfLimits.load(std::memory_order_acquire) > 0; }
  /** In a file while there is a limit. @throws std::bad_alloc, ScratchFull. */
  void* Map(std::size_t bytes);
  /** @return whether it was such memory. */
  bool Unmap(void* memory) noexcept;
  /** Does what the governor does, if nobody has for a tenth of a millisecond. */
  void KeepIfDue();

private:
  /** The thread that looks at the memory. */
  struct Governor;

  ScratchStore();
  std::size_t SmallestLimit() const;
  void Record(const ResidentMemory& memory);
  /** Until so much is resident, once around at most. @return what is resident then. */
  ResidentMemory Drop(const ResidentMemoryMeter& meter, std::size_t goal);
  /** Drops what must be, with so many bytes to come at once. @return what is resident then. */
  ResidentMemory Keep(const ResidentMemoryMeter& meter, std::size_t toCome = 0);
  void Start();
  void Stop(std::unique_lock<std::mutex>& lock);
  void Govern(Governor& governor);
  void GoOnInChild();

  std::mutex Mutex; ///< For all that follows.
  std::vector<ScratchLimit*> Limits;
  std::atomic<std::size_t> NumberOfLimits{ 0 };
  std::atomic<std::int64_t> LastKept{ 0 }; ///< Microseconds of the steady clock.
  std::atomic<bool> IsKeeping{ false };    ///< Pages are being dropped, if any must be.
  using Arrays = std::map<std::uintptr_t, std::size_t>; ///< Bytes by address.
  Arrays InFiles;
  Arrays InMemory;
  std::atomic<std::size_t> NumberOfArrays{ 0 };
  std::size_t Mapped = 0;  ///< Bytes, of files.
  std::uintptr_t Hand = 0; ///< Where dropping goes on.
  std::unique_ptr<Governor> Governing;
};
}

#endif
