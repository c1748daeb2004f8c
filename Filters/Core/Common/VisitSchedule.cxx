// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/VisitSchedule.h"

#include <chrono>
#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <queue>
#include <utility>

namespace volumic
{
namespace
{
/** Threads that take visits at most. */
constexpr std::size_t MostThreads = 256;
/** How long visits are taken before the host is asked whether to go on. */
constexpr std::chrono::milliseconds Round(50);
}

/** What is ready, under way and done; threads share it. */
class VisitSchedule::Progress
{
public:
  explicit Progress(const VisitSchedule& schedule)
    : Schedule(schedule)
    , Waits(schedule.Earlier)
  {
    for (const int item : schedule.Items)
    {
      if (this->Waits[item] == 0)
      {
        this->Ready.push(schedule.Place[item]);
      }
    }
  }

  bool IsAllDone() const { return this->Done == this->Schedule.Items.size(); }
  std::size_t NumberDone() const { return this->Done; }

  void BeginRound() { this->End = std::chrono::steady_clock::now() + Round; }

  /** Takes visits until the round ends, or all are done, or one has failed. */
  void Work(const std::function<void(int, std::size_t)>& visit)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      this->HasChanged.wait(
        lock, [this] { return !this->Ready.empty() || this->UnderWay == 0 || this->HasFailed; });
      if (this->Ready.empty() || this->HasFailed ||
        (this->HasBegun && std::chrono::steady_clock::now() >= this->End))
      {
        return;
      }
      this->HasBegun = true; // A round makes one visit at least.
      const std::size_t place = static_cast<std::size_t>(this->Ready.top());
      this->Ready.pop();
      ++this->UnderWay;
      lock.unlock();
      const int item = this->Schedule.Items[place];
      try
      {
        visit(item, place);
      }
      catch (...)
      {
        lock.lock();
        --this->UnderWay;
        this->HasFailed = true;
        this->HasChanged.notify_all();
        throw;
      }
      lock.lock();
      --this->UnderWay;
      ++this->Done;
      for (const int later : this->Schedule.Later[item])
      {
        if (--this->Waits[later] == 0)
        {
          this->Ready.push(this->Schedule.Place[later]);
        }
      }
      this->HasChanged.notify_all();
    }
  }

  void EndRound() { this->HasBegun = false; }

private:
  const VisitSchedule& Schedule;
  std::mutex Mutex; ///< Of all that follows, while threads work.
  std::condition_variable HasChanged;
  std::vector<int> Waits; ///< Of an item: how many of those before it are not done.
  std::priority_queue<int, std::vector<int>, std::greater<int>> Ready; ///< Places in the order.
  int UnderWay = 0;
  std::size_t Done = 0;
  bool HasBegun = false;
  bool HasFailed = false;
  std::chrono::steady_clock::time_point End;
};

VisitSchedule::VisitSchedule(
  std::vector<int> order, const std::function<std::vector<int>(int item)>& neighbours)
  : Items(std::move(order))
  , Place(this->Items.size())
  , Earlier(this->Items.size(), 0)
  , Later(this->Items.size())
{
  for (std::size_t place = 0; place < this->Items.size(); ++place)
  {
    this->Place[this->Items[place]] = static_cast<int>(place);
  }
  for (const int item : this->Items)
  {
    for (const int other : neighbours(item))
    {
      if (this->Place[other] < this->Place[item])
      {
        ++this->Earlier[item];
      }
      else
      {
        this->Later[item].push_back(other);
      }
    }
  }
}

bool VisitSchedule::Run(Executor& executor,
  const std::function<void(int item, std::size_t place)>& visit,
  const std::function<bool(std::size_t done)>& goOn) const
{
  Progress progress(*this);
  const std::size_t threads = std::min(MostThreads, this->Items.size());
  while (!progress.IsAllDone())
  {
    progress.BeginRound();
    executor.For(threads, 1,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          progress.Work(visit);
        }
      });
    progress.EndRound();
    if (!goOn(progress.NumberDone()))
    {
      return false;
    }
  }
  return true;
}
}
