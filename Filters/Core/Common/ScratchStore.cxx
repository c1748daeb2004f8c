// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchStore.h"

#include "Core/Common/Refuse.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

namespace volumic
{
namespace
{
/**
 * How far below the limit dropping begins: what threads may fill until somebody looks again, on a
 * machine with more to do than it has processors.
 */
std::size_t HeadroomOf(std::size_t limit)
{
  return std::min(std::max(limit / 5 * 2, 32 * Mebibyte), 1024 * Mebibyte);
}
}

struct ScratchStore::Governor
{
  ResidentMemoryMeter Meter;
  std::condition_variable Wake;
  bool Ends = false;
  std::thread Thread;
};

ScratchStore::ScratchStore()
{
  // Nobody else may be in the midst of a change when the process is copied.
  CallAtForks([] { Instance().Mutex.lock(); }, [] { Instance().Mutex.unlock(); },
    [] { Instance().GoOnInChild(); });
}

void ScratchStore::GoOnInChild()
{
  for (const auto& array : this->InFiles)
  {
    ProtectPages(reinterpret_cast<void*>(array.first), array.second);
  }
  // They are the parent's, and so is the thread: there is none to be waited for.
  this->Limits.clear();
  this->NumberOfLimits = 0;
  static_cast<void>(this->Governing.release());
  this->Mutex.unlock();
}

std::size_t ScratchStore::SmallestLimit() const
{
  std::size_t smallest = SIZE_MAX;
  for (const ScratchLimit* limit : this->Limits)
  {
    smallest = std::min(smallest, limit->Options.Limit);
  }
  return smallest;
}

void ScratchStore::Add(ScratchLimit& limit)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  // What is left of other runs need not be resident.
  const ResidentMemoryMeter meter;
  const std::size_t held = this->Drop(meter, 0).All;
  const std::size_t least = held + ScratchMemory::LeastBytes;
  if (limit.Options.Limit < least)
  {
    Refuse("Memory Limit is ", Mebibytes(limit.Options.Limit), " MiB, but the process holds ",
      Mebibytes(held), " MiB already, for programs, libraries and data. It must be ",
      Mebibytes(least), " MiB at least; 0 is no limit.");
  }
  // What may fail comes first: a limit that could not be set must not be known of.
  this->Limits.reserve(this->Limits.size() + 1);
  if (!this->Governing)
  {
    this->Start();
  }
  this->Limits.push_back(&limit);
  this->NumberOfLimits = this->Limits.size();
}

void ScratchStore::Remove(ScratchLimit& limit)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const auto at = std::find(this->Limits.begin(), this->Limits.end(), &limit);
  if (at == this->Limits.end())
  {
    return; // In a child of the process.
  }
  this->Limits.erase(at);
  this->NumberOfLimits = this->Limits.size();
  if (this->Limits.empty())
  {
    this->Stop(lock);
  }
}

ScratchStatistics ScratchStore::StatisticsOf(const ScratchLimit& limit)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  ScratchStatistics statistics = limit.Statistics;
  statistics.Mapped = this->Mapped;
  return statistics;
}

void ScratchStore::Record(const ResidentMemory& memory)
{
  for (ScratchLimit* limit : this->Limits)
  {
    ScratchStatistics& statistics = limit->Statistics;
    statistics.MostResident = std::max(statistics.MostResident, memory.All);
    statistics.MostAnonymous = std::max(statistics.MostAnonymous, memory.Anonymous);
  }
}

void* ScratchStore::Map(std::size_t bytes)
{
  std::string directory;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (!this->Limits.empty())
    {
      this->Keep(this->Governing->Meter, bytes); // It will be filled at once, mostly.
      directory = this->Limits.back()->Options.Directory;
    }
  }
  const bool isInFile = !directory.empty();
  void* memory = isInFile ? MapScratchFile(directory, bytes) : MapZeroed(bytes);
  const std::lock_guard<std::mutex> lock(this->Mutex);
  try
  {
    (isInFile ? this->InFiles : this->InMemory)
      .emplace(reinterpret_cast<std::uintptr_t>(memory), bytes);
  }
  catch (...)
  {
    UnmapScratchFile(memory, bytes);
    throw;
  }
  ++this->NumberOfArrays;
  this->Mapped += isInFile ? bytes : 0;
  return memory;
}

bool ScratchStore::Unmap(void* memory) noexcept
{
  constexpr std::uintptr_t smallestPage = 4096;
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  if (address % smallestPage != 0 || this->NumberOfArrays.load(std::memory_order_acquire) == 0)
  {
    return false;
  }
  Arrays::node_type array;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    array = this->InMemory.extract(address);
    if (array.empty())
    {
      array = this->InFiles.extract(address);
      this->Mapped -= array.empty() ? 0 : array.mapped();
    }
    this->NumberOfArrays -= array.empty() ? 0 : 1;
  }
  if (array.empty())
  {
    return false;
  }
  UnmapScratchFile(memory, array.mapped());
  return true;
}

namespace
{
std::int64_t Microseconds()
{
  using namespace std::chrono;
  return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}
}

void ScratchStore::KeepIfDue()
{
  constexpr std::int64_t interval = 100;
  const auto isDue = [this] { return Microseconds() - this->LastKept >= interval; };
  // Who drops pages may have lost its processor to those who fill them: they wait for it.
  if (!this->IsKeeping && !isDue())
  {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (this->Governing && isDue())
  {
    this->Keep(this->Governing->Meter);
  }
}

ResidentMemory ScratchStore::Drop(const ResidentMemoryMeter& meter, std::size_t goal)
{
  constexpr std::size_t stepsAtATime = 4;
  ResidentMemory before = meter.Read();
  std::size_t left = this->Mapped + ScratchStep * this->InFiles.size(); // Once around.
  while (before.All > goal && left > 0 && !this->InFiles.empty())
  {
    for (std::size_t i = 0; i < stepsAtATime && left > 0; ++i)
    {
      // The array that the hand is in, or the next one, or the first.
      auto array = this->InFiles.upper_bound(this->Hand);
      if (array != this->InFiles.begin() &&
        this->Hand < std::prev(array)->first + std::prev(array)->second)
      {
        --array;
      }
      else
      {
        array = array != this->InFiles.end() ? array : this->InFiles.begin();
        this->Hand = array->first;
      }
      const std::uintptr_t begin = this->Hand;
      // Up to the next multiple of a step, which is a table of the processor's.
      const std::uintptr_t end =
        std::min(array->first + array->second, begin / ScratchStep * ScratchStep + ScratchStep);
      DropPages(reinterpret_cast<void*>(begin), end - begin);
      this->Hand = end;
      left -= std::min(left, end - begin);
    }
    const ResidentMemory after = meter.Read();
    for (ScratchLimit* limit : this->Limits)
    {
      limit->Statistics.Dropped += before.All - std::min(before.All, after.All);
    }
    before = after;
  }
  return before;
}

ResidentMemory ScratchStore::Keep(const ResidentMemoryMeter& meter, std::size_t toCome)
{
  const std::size_t limit = this->SmallestLimit();
  this->IsKeeping = true;
  ResidentMemory memory = meter.Read();
  this->Record(memory);
  const std::size_t headroom = HeadroomOf(limit);
  const std::size_t ahead = std::min(toCome, headroom);
  if (memory.All + ahead > limit - headroom)
  {
    memory = this->Drop(meter, limit - std::min(limit, headroom + headroom / 4 + ahead));
  }
  this->LastKept = Microseconds();
  this->IsKeeping = false;
  return memory;
}

void ScratchStore::Start()
{
  auto governor = std::make_unique<Governor>();
  try
  {
    governor->Thread = std::thread([this, g = governor.get()] { this->Govern(*g); });
  }
  catch (const std::system_error& error)
  {
    throw std::runtime_error(Join("Memory Limit needs a thread of its own, and the system denies "
                                  "one (",
      error.code().message(),
      "). Let the process have more threads (ulimit -u), or set "
      "Memory Limit to 0, which is no limit."));
  }
  this->Governing = std::move(governor);
}

void ScratchStore::Stop(std::unique_lock<std::mutex>& lock)
{
  const std::unique_ptr<Governor> governor = std::move(this->Governing);
  governor->Ends = true;
  governor->Wake.notify_all();
  lock.unlock();
  governor->Thread.join();
}

void ScratchStore::Govern(Governor& governor)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  while (!governor.Ends)
  {
    const std::size_t limit = this->SmallestLimit();
    const ResidentMemory memory = this->Keep(governor.Meter);
    const std::size_t begin = limit - HeadroomOf(limit);
    // Microseconds: as long as it takes to fill what is free until then, at 60 GB/s (two threads
    // that read what is cached: 36). Where nothing is left to be dropped, arrays may stay for a
    // while: else all would be waiting for pages.
    const std::size_t wait = memory.All < begin
      ? std::min<std::size_t>(200 + (begin - memory.All) / Mebibyte * 16, 10000)
      : (memory.Anonymous < limit ? 2000 : 20000);
    governor.Wake.wait_for(lock, std::chrono::microseconds(wait));
  }
}
}
