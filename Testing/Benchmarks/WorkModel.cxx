// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "WorkModel.h"

#include <algorithm>
#include <ctime>
#include <queue>
#include <utility>

namespace volumic
{
namespace bench
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

double ScheduledSeconds(const VisitSchedule& schedule, const std::vector<double>& visits,
  int threads, double secondsOfVisit)
{
  const std::vector<int>& order = schedule.Order();
  std::vector<int> placeOf(order.size());
  std::vector<int> waits(order.size());
  std::priority_queue<int, std::vector<int>, std::greater<int>> ready; // Places in the order.
  for (std::size_t place = 0; place < order.size(); ++place)
  {
    placeOf[order[place]] = static_cast<int>(place);
    waits[order[place]] = schedule.NumberOfEarlier(order[place]);
    if (waits[order[place]] == 0)
    {
      ready.push(static_cast<int>(place));
    }
  }
  using End = std::pair<double, int>; // Of a visit under way, and its item.
  std::priority_queue<End, std::vector<End>, std::greater<End>> underWay;
  double now = 0.0;
  while (!ready.empty() || !underWay.empty())
  {
    while (!ready.empty() && static_cast<int>(underWay.size()) < threads)
    {
      const int item = order[ready.top()];
      ready.pop();
      underWay.push({ now + visits[item] + secondsOfVisit, item });
    }
    now = underWay.top().first;
    const int done = underWay.top().second;
    underWay.pop();
    for (const int later : schedule.LaterThan(done))
    {
      if (--waits[later] == 0)
      {
        ready.push(placeOf[later]);
      }
    }
  }
  return now;
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

bool WorkModel::MakeVisits(
  const VisitSchedule& schedule, const std::function<void(int, std::size_t)>& visit)
{
  this->Present.Serial += std::max(0.0, Now() - this->Mark - this->ClockSeconds);
  std::vector<double> seconds(schedule.Order().size(), 0.0);
  {
    const Inside inside(this->IsInside);
    double last = Now();
    for (std::size_t place = 0; place < seconds.size(); ++place)
    {
      const int item = schedule.Order()[place];
      visit(item, place);
      const double now = Now();
      seconds[item] = std::max(0.0, now - last - this->ClockSeconds);
      this->Present.Parallel += seconds[item];
      last = now;
    }
  }
  this->Present.Calls += 1.0;
  this->Present.Chunks += static_cast<double>(seconds.size());
  for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
  {
    this->Present.Scheduled[i] += this->Overhead.SecondsOfCall +
      ScheduledSeconds(schedule, seconds, ModelledThreads[i], this->Overhead.SecondsOfChunk);
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

} // namespace bench
} // namespace volumic
