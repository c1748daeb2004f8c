// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/VisitSchedule.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <queue>
#include <thread>
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
  Progress(const VisitSchedule& schedule, const std::function<bool(std::size_t done)>& goOn)
    : Schedule(schedule)
    , GoOn(goOn)
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
  bool IsStopped() const { return this->Stopped; }

  void BeginRound()
  {
    this->End = std::chrono::steady_clock::now() + Round;
    this->HasBegun = this->CallerWorks = this->HasAsked = false;
  }
  void EndRound()
  {
    if (!this->HasAsked) // Others have made all the visits.
    {
      this->Stopped = !this->GoOn(this->Done);
    }
  }

  /** Takes visits until the round ends, or all are done, or one has failed. */
  void Work(const std::function<void(int, std::size_t)>& visit)
  {
    const bool isCaller = std::this_thread::get_id() == this->Caller;
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->CallerWorks = this->CallerWorks || isCaller;
    while (true)
    {
      this->HasChanged.wait(
        lock, [this] { return !this->Ready.empty() || this->UnderWay == 0 || this->IsOver(); });
      // A round makes one visit at least; it needs no end where the calling thread asks itself.
      if (this->Ready.empty() || this->IsOver() ||
        (this->HasBegun && !this->CallerWorks && std::chrono::steady_clock::now() >= this->End))
      {
        return;
      }
      this->HasBegun = true;
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
      const std::size_t done = ++this->Done;
      for (const int later : this->Schedule.Later[item])
      {
        if (--this->Waits[later] == 0)
        {
          this->Ready.push(this->Schedule.Place[later]);
        }
      }
      this->HasChanged.notify_all();
      if (isCaller && !this->IsOver())
      {
        this->HasAsked = true;
        lock.unlock();
        const bool goesOn = this->GoOn(done);
        lock.lock();
        this->Stopped = this->Stopped || !goesOn;
      }
    }
  }

private:
  bool IsOver() const { return this->HasFailed || this->Stopped; }

  const VisitSchedule& Schedule;
  const std::function<bool(std::size_t done)>& GoOn;
  const std::thread::id Caller = std::this_thread::get_id();
  std::mutex Mutex; ///< Of all that follows, while threads work.
  std::condition_variable HasChanged;
  std::vector<int> Waits; ///< Of an item: how many of those before it are not done.
  std::priority_queue<int, std::vector<int>, std::greater<int>> Ready; ///< Places in the order.
  int UnderWay = 0;
  std::size_t Done = 0;
  bool HasBegun = false;
  bool CallerWorks = false; ///< The calling thread is one of them, in this round.
  bool HasAsked = false;    ///< It has been asked whether to go on, in this round.
  bool HasFailed = false;
  bool Stopped = false;
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
  if (executor.MakeVisits(*this, visit))
  {
    return goOn(this->Items.size());
  }
  Progress progress(*this, goOn);
  const std::size_t threads = std::min(MostThreads, this->Items.size());
  while (!progress.IsAllDone() && !progress.IsStopped())
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
  }
  return !progress.IsStopped();
}
}
