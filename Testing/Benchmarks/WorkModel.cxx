// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "WorkModel.h"

#include <algorithm>
#include <ctime>
#include <numeric>
#include <queue>
#include <utility>

namespace volumic::bench
{
namespace
{

/** As in StandardThreads. */
constexpr std::size_t ChunksPerThread = 8;

/** Seconds of the processor in this thread. */
double Now()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double SecondsOfClock()
{
  double least = 1.0;
  for (int i = 0; i < 10000; ++i)
  {
    const double begin = Now();
    least = std::min(least, Now() - begin);
  }
  return least;
}

std::size_t ChunkSize(std::size_t n, std::size_t grain, int threads)
{
  return std::max(
    { grain, n / (ChunksPerThread * static_cast<std::size_t>(threads)), std::size_t(1) });
}

/** Within a body; also where that throws, until its end. */
struct Inside
{
  explicit Inside(bool& flag) : Flag(flag) { this->Flag = true; }
  ~Inside() { this->Flag = false; }
  bool& Flag;
};

} // namespace

double ScheduledSeconds(const std::vector<double>& chunks, int threads, double secondsOfChunk)
{
  // When each thread is free, the earliest on top.
  std::priority_queue<double, std::vector<double>, std::greater<double>> free;
  for (int i = 0; i < threads; ++i)
  {
    free.push(0.0);
  }
  double last = 0.0;
  for (const double seconds : chunks)
  {
    const double end = free.top() + seconds + secondsOfChunk;
    free.pop();
    free.push(end);
    last = std::max(last, end);
  }
  return last;
}

namespace
{

/** Makes visits as VisitSchedule::Run does, in a time of its own. */
class ModelledVisits
{
public:
  ModelledVisits(const VisitSchedule& schedule, const std::vector<std::vector<VisitStep>>& steps,
    int threads, const ThreadOverhead& overhead)
    : Schedule(schedule), Steps(steps), Overhead(overhead), Free(threads),
      PlaceOf(schedule.Order().size()), Waits(schedule.Order().size()), Visits(steps.size())
  {
    for (std::size_t place = 0; place < this->PlaceOf.size(); ++place)
    {
      const int item = schedule.Order()[place];
      this->PlaceOf[item] = static_cast<int>(place);
      this->Waits[item] = schedule.NumberOfEarlier(item);
      if (this->Waits[item] == 0)
      {
        this->Ready.push(static_cast<int>(place));
      }
    }
  }

  double Run()
  {
    this->Employ();
    while (!this->Ends.empty())
    {
      const End end = this->Ends.top();
      this->Ends.pop();
      this->Now = end.Time;
      Visit& visit = this->Visits[end.Item];
      visit.UnderWay -= end.IsPart;
      visit.IsOpen = visit.IsOpen || !end.IsPart;
      if (end.IsOwner)
      {
        visit.OwnerWaits = true;
      }
      else
      {
        ++this->Free;
      }
      this->GoOn(end.Item);
      this->Employ();
    }
    return this->Now;
  }

private:
  struct Visit
  {
    std::size_t Step = 0;
    std::size_t NextPart = 0;
    int UnderWay = 0;        ///< Parts.
    bool IsOpen = false;     ///< What is for one thread alone is done: parts may be taken.
    bool OwnerWaits = false; ///< The thread that has taken the visit has nothing to do.
  };
  struct End
  {
    double Time;
    int Item;
    bool IsPart;
    bool IsOwner;
    bool operator>(const End& other) const { return this->Time > other.Time; }
  };

  bool HasPart(int item) const
  {
    const Visit& visit = this->Visits[item];
    return visit.IsOpen && visit.NextPart < this->Steps[item][visit.Step].Parts.size();
  }

  void TakePart(int item, bool isOwner)
  {
    Visit& visit = this->Visits[item];
    const double seconds = this->Steps[item][visit.Step].Parts[visit.NextPart++] +
      this->Overhead.SecondsOfChunk + (isOwner ? 0.0 : this->Overhead.SecondsOfCall);
    ++visit.UnderWay;
    this->Ends.push({ this->Now + seconds, item, true, isOwner });
  }

  void BeginStep(int item)
  {
    Visit& visit = this->Visits[item];
    visit.IsOpen = visit.OwnerWaits = false;
    visit.NextPart = 0;
    this->Ends.push({ this->Now + this->Steps[item][visit.Step].Alone + this->Overhead.SecondsOfChunk,
      item, false, true });
  }

  /** What the thread of a visit does next, if it waits. */
  void GoOn(int item)
  {
    Visit& visit = this->Visits[item];
    if (!visit.OwnerWaits)
    {
      return;
    }
    if (this->HasPart(item))
    {
      visit.OwnerWaits = false;
      this->TakePart(item, true);
    }
    else if (visit.UnderWay == 0 && visit.Step + 1 < this->Steps[item].size())
    {
      ++visit.Step;
      this->BeginStep(item);
    }
    else if (visit.UnderWay == 0)
    {
      visit.OwnerWaits = visit.IsOpen = false;
      ++this->Free;
      this->Shared.erase(std::find(this->Shared.begin(), this->Shared.end(), item));
      for (const int later : this->Schedule.LaterThan(item))
      {
        if (--this->Waits[later] == 0)
        {
          this->Ready.push(this->PlaceOf[later]);
        }
      }
    }
  }

  /** Threads that are free take visits, else parts. */
  void Employ()
  {
    for (; this->Free > 0 && !this->Ready.empty(); --this->Free)
    {
      const int item = this->Schedule.Order()[this->Ready.top()];
      this->Ready.pop();
      this->Shared.push_back(item);
      this->BeginStep(item);
    }
    for (std::size_t i = 0; i < this->Shared.size() && this->Free > 0; ++i)
    {
      for (; this->Free > 0 && this->HasPart(this->Shared[i]); --this->Free)
      {
        this->TakePart(this->Shared[i], false);
      }
    }
  }

  const VisitSchedule& Schedule;
  const std::vector<std::vector<VisitStep>>& Steps;
  const ThreadOverhead Overhead;
  int Free; ///< Threads.
  double Now = 0.0;
  std::vector<int> PlaceOf;
  std::vector<int> Waits;
  std::vector<Visit> Visits;
  std::vector<int> Shared; ///< Visits under way.
  std::priority_queue<int, std::vector<int>, std::greater<int>> Ready; ///< Places in the order.
  std::priority_queue<End, std::vector<End>, std::greater<End>> Ends;
};

/** Does all that a visit would share on this thread, and times it. */
class StepTimes final : public Executor
{
public:
  explicit StepTimes(double clockSeconds) : ClockSeconds(clockSeconds) {}

  void Begin()
  {
    this->Steps.assign(1, VisitStep());
    this->Mark = Now();
  }
  std::vector<VisitStep> Take()
  {
    this->Steps.back().Alone += this->Lap();
    return std::move(this->Steps);
  }

  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body) override
  {
    if (n == 0)
    {
      return;
    }
    if (n <= grain || this->IsInside)
    {
      body(0, n);
      return;
    }
    const Inside inside(this->IsInside);
    this->Steps.back().Alone += this->Lap();
    for (std::size_t begin = 0; begin < n; begin += grain)
    {
      body(begin, std::min(n, begin + grain));
      this->Steps.back().Parts.push_back(this->Lap());
    }
    this->Steps.emplace_back();
  }

private:
  double Lap()
  {
    const double now = Now();
    const double seconds = std::max(0.0, now - this->Mark - this->ClockSeconds);
    this->Mark = now;
    return seconds;
  }

  double ClockSeconds;
  double Mark = 0.0;
  bool IsInside = false;
  std::vector<VisitStep> Steps;
};

double SumOf(const std::vector<VisitStep>& steps)
{
  double sum = 0.0;
  for (const VisitStep& step : steps)
  {
    sum = std::accumulate(step.Parts.begin(), step.Parts.end(), sum + step.Alone);
  }
  return sum;
}

} // namespace

double ScheduledSeconds(const VisitSchedule& schedule,
  const std::vector<std::vector<VisitStep>>& visits, int threads, const ThreadOverhead& overhead)
{
  return ModelledVisits(schedule, visits, threads, overhead).Run();
}

std::vector<double> JoinedChunks(
  const std::vector<double>& chunks, std::size_t fine, std::size_t size)
{
  std::vector<double> joined;
  std::size_t items = size;
  for (const double seconds : chunks)
  {
    if (items >= size)
    {
      joined.push_back(0.0);
      items = 0;
    }
    joined.back() += seconds;
    items += fine;
  }
  return joined;
}

//------------------------------------------------------------------------------
WorkModel::Phase& WorkModel::Phase::operator+=(const Phase& other)
{
  this->Serial += other.Serial;
  this->Small += other.Small;
  this->Parallel += other.Parallel;
  this->Calls += other.Calls;
  this->Chunks += other.Chunks;
  for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
  {
    this->Scheduled[i] += other.Scheduled[i];
  }
  return *this;
}

WorkModel::WorkModel(const ThreadOverhead& overhead)
  : Overhead(overhead), ClockSeconds(SecondsOfClock())
{
}

void WorkModel::Start()
{
  this->Present = Phase();
  this->Ended.clear();
  this->Mark = Now();
}

void WorkModel::RunChunks(
  std::size_t n, std::size_t size, const std::function<void(std::size_t, std::size_t)>& body)
{
  const Inside inside(this->IsInside);
  double last = Now();
  for (std::size_t begin = 0; begin < n; begin += size)
  {
    body(begin, std::min(n, begin + size));
    const double now = Now();
    this->Times.push_back(std::max(0.0, now - last - this->ClockSeconds));
    last = now;
  }
}

void WorkModel::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (n == 0)
  {
    return;
  }
  if (this->IsInside)
  {
    body(0, n);
    return;
  }
  if (n <= grain)
  {
    const Inside inside(this->IsInside);
    const double begin = Now();
    body(0, n);
    this->Present.Small += std::max(0.0, Now() - begin - this->ClockSeconds);
    return;
  }
  this->Present.Serial += std::max(0.0, Now() - this->Mark - this->ClockSeconds);
  const std::size_t fine = ChunkSize(n, grain, ModelledThreads.back());
  this->Times.clear();
  this->RunChunks(n, fine, body);
  for (const double seconds : this->Times)
  {
    this->Present.Parallel += seconds;
  }
  this->Present.Calls += 1.0;
  this->Present.Chunks += static_cast<double>(this->Times.size());
  for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
  {
    const int threads = ModelledThreads[i];
    this->Present.Scheduled[i] += this->Overhead.SecondsOfCall +
      ScheduledSeconds(JoinedChunks(this->Times, fine, ChunkSize(n, grain, threads)), threads,
        this->Overhead.SecondsOfChunk);
  }
  this->Mark = Now(); // The reckoning does not count.
}

bool WorkModel::MakeVisits(const VisitSchedule& schedule, const VisitBody& visit)
{
  this->Present.Serial += std::max(0.0, Now() - this->Mark - this->ClockSeconds);
  std::vector<std::vector<VisitStep>> visits(schedule.Order().size());
  {
    const Inside inside(this->IsInside);
    StepTimes times(this->ClockSeconds);
    for (std::size_t place = 0; place < visits.size(); ++place)
    {
      const int item = schedule.Order()[place];
      times.Begin();
      visit(item, place, times);
      visits[item] = times.Take();
      this->Present.Parallel += SumOf(visits[item]);
    }
  }
  this->Present.Calls += 1.0;
  this->Present.Chunks += static_cast<double>(visits.size());
  for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
  {
    this->Present.Scheduled[i] += this->Overhead.SecondsOfCall +
      ScheduledSeconds(schedule, visits, ModelledThreads[i], this->Overhead);
  }
  this->Mark = Now(); // The reckoning does not count.
  return true;
}

void WorkModel::EndPhase(const char* name)
{
  this->Present.Serial += std::max(0.0, Now() - this->Mark - this->ClockSeconds);
  auto found = std::find_if(this->Ended.begin(), this->Ended.end(),
    [name](const Phase& phase) { return phase.Name == name; });
  if (found == this->Ended.end())
  {
    this->Ended.emplace_back();
    found = this->Ended.end() - 1;
    found->Name = name;
  }
  *found += this->Present;
  this->Present = Phase();
  this->Mark = Now();
}

} // namespace volumic::bench
