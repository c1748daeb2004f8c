// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/VisitSchedule.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/** Threads that take visits, or chunks of them, at most. */
constexpr std::size_t MostThreads = 256;
/** Chunks for each thread that shares in a visit, as some take longer than others. */
constexpr std::size_t ChunksPerThread = 4;
/** How long visits are taken before the host is asked whether to go on. */
constexpr std::chrono::milliseconds Round(50);
}

/**
 * What is ready, under way and done; threads share it. Those that find no visit that is ready take
 * chunks of what visits under way have handed to For().
 */
class VisitSchedule::Progress final : public Executor
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

  /** Called within a visit. */
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    const std::size_t idle = this->Idle;
    if (idle == 0 || n <= grain)
    {
      if (n > 0)
      {
        body(0, n);
      }
      return;
    }
    SharedWork work{ body, 0, n, std::max(grain, n / (ChunksPerThread * (idle + 1))), 0, nullptr };
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Shared.push_back(&work);
    this->HasChanged.notify_all();
    this->TakeChunks(work, lock);
    this->HasEnded.wait(lock, [&work] { return work.UnderWay == 0; });
    this->Shared.erase(std::find(this->Shared.begin(), this->Shared.end(), &work));
    lock.unlock();
    if (work.Exception)
    {
      std::rethrow_exception(work.Exception);
    }
  }

  /** Takes visits until the round ends, or all are done, or one has failed. */
  void Work(const VisitBody& visit)
  {
    const bool isCaller = std::this_thread::get_id() == this->Caller;
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->CallerWorks = this->CallerWorks || isCaller;
    while (true)
    {
      SharedWork* shared = nullptr;
      if (!this->WaitForWork(shared, isCaller, lock))
      {
        this->Ask(lock);
        continue;
      }
      if (shared && (this->Ready.empty() || this->IsOver()))
      {
        this->TakeChunks(*shared, lock);
        continue;
      }
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
        visit(item, place, *this);
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
      if (isCaller && !this->IsOver())
      {
        this->Ask(lock);
      }
    }
  }

private:
  /** What a visit has handed to For(). */
  struct SharedWork
  {
    const std::function<void(std::size_t begin, std::size_t end)>& Body;
    std::size_t Next;
    std::size_t End;
    std::size_t Chunk; ///< Items of one.
    int UnderWay; ///< Chunks.
    std::exception_ptr Exception;
  };

  bool IsOver() const { return this->HasFailed || this->Stopped; }

  /**
   * @param shared what threads may share in, or null
   * @return false where the calling thread has found no visit to make for a round, and must ask
   */
  bool WaitForWork(
    SharedWork*& shared, bool isCaller, std::unique_lock<std::mutex>& lock)
  {
    const auto hasWork = [&]
    {
      shared = this->FindShared();
      return !this->Ready.empty() || shared || this->UnderWay == 0 || this->IsOver();
    };
    ++this->Idle;
    bool isInTime = true;
    if (isCaller)
    {
      isInTime = this->HasChanged.wait_until(lock, this->End, hasWork) &&
        (!shared || this->IsOver() || std::chrono::steady_clock::now() < this->End);
    }
    else
    {
      this->HasChanged.wait(lock, hasWork);
    }
    --this->Idle;
    return isInTime;
  }

  /** On the calling thread. */
  void Ask(std::unique_lock<std::mutex>& lock)
  {
    const std::size_t done = this->Done;
    this->HasAsked = true;
    lock.unlock();
    const bool goesOn = this->GoOn(done);
    lock.lock();
    this->Stopped = this->Stopped || !goesOn;
    this->End = std::chrono::steady_clock::now() + Round;
  }

  /** The first of which any chunk is left, or null. */
  SharedWork* FindShared() const
  {
    const auto found = std::find_if(this->Shared.begin(), this->Shared.end(),
      [](const SharedWork* work) { return work->Next < work->End; });
    return found != this->Shared.end() ? *found : nullptr;
  }

  /** Until none is left; others may be under way then. */
  void TakeChunks(SharedWork& work, std::unique_lock<std::mutex>& lock)
  {
    while (work.Next < work.End)
    {
      const std::size_t begin = work.Next;
      const std::size_t end = std::min(begin + work.Chunk, work.End);
      work.Next = end;
      ++work.UnderWay;
      lock.unlock();
      std::exception_ptr exception;
      try
      {
        work.Body(begin, end);
      }
      catch (...)
      {
        exception = std::current_exception();
      }
      lock.lock();
      --work.UnderWay;
      if (exception)
      {
        work.Next = work.End; // What is left is not worth doing.
        work.Exception = exception;
      }
    }
    this->HasEnded.notify_all();
  }

  const VisitSchedule& Schedule;
  const std::function<bool(std::size_t done)>& GoOn;
  const std::thread::id Caller = std::this_thread::get_id();
  std::mutex Mutex; ///< Of all that follows, while threads work.
  std::condition_variable HasChanged;
  std::condition_variable HasEnded; ///< Chunks of what is shared.
  std::vector<SharedWork*> Shared;
  std::atomic<std::size_t> Idle{ 0 }; ///< Threads that wait for something to do.
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

bool VisitSchedule::Run(Executor& executor, const VisitBody& visit,
  const std::function<bool(std::size_t done)>& goOn) const
{
  Progress progress(*this, goOn);
  while (!progress.IsAllDone() && !progress.IsStopped())
  {
    progress.BeginRound();
    executor.For(MostThreads, 1,
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
