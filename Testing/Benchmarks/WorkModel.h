// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How long a run would take on more processors than there are. */

#ifndef volumicWorkModel_h
#define volumicWorkModel_h

#include "Core/Common/Executor.h"
#include "Core/Common/VisitSchedule.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace volumic::bench
{

/** Numbers of threads that are modelled. */
constexpr std::array<int, 6> ModelledThreads = { 2, 4, 8, 16, 32, 64 };

/** What a call of For() and a chunk of it cost beside the work; see WorkModel. */
struct ThreadOverhead
{
  double SecondsOfCall = 10e-6;
  double SecondsOfChunk = 0.5e-6;
};

/** The seconds that `threads` need for chunks which each of them takes when it is free, in this
    order (list scheduling), with the time of a chunk beside its work. */
double ScheduledSeconds(
  const std::vector<double>& chunks, int threads, double secondsOfChunk = 0.0);

/** Work of a visit for one thread, and then parts in which others that are idle may share. */
struct VisitStep
{
  double Alone = 0.0;
  std::vector<double> Parts;
};

/** The same for visits, of which a schedule tells what waits for what; their steps by item. */
double ScheduledSeconds(const VisitSchedule& schedule,
  const std::vector<std::vector<VisitStep>>& visits, int threads,
  const ThreadOverhead& overhead = { 0.0, 0.0 });

/** Chunks of `size` items made of finer ones of `fine` items each (the last one may have less). */
std::vector<double> JoinedChunks(
  const std::vector<double>& chunks, std::size_t fine, std::size_t size);

/**
 * Does all on the calling thread, chunk by chunk, and reckons what it would take on P threads.
 *
 * A call of For() is cut into the chunks that StandardThreads makes for the largest P, 8 per thread
 * but none smaller than the grain (one by one where that is 1 and items are few); for a smaller P
 * neighbours are put together. Each chunk's time is that of the processor in this thread, less what
 * reading the clock takes. Threads take chunks in order, each when it is free; the call itself and
 * each chunk cost some time more. A call of no more than the grain stays on one thread, and so does
 * all that happens between the calls: the serial time, which is added as it is.
 *
 * Left out: that processors share memory and caches, and slow down when all of them work.
 */
class WorkModel final : public Executor
{
public:
  struct Phase
  {
    std::string Name;
    double Serial = 0.0;   ///< seconds on one thread, whatever the number of threads
    double Small = 0.0;    ///< of these in calls of no more than the grain
    double Parallel = 0.0; ///< seconds of all chunks together
    /** Seconds of the parallel part on so many threads. */
    std::array<double, ModelledThreads.size()> Scheduled{};
    double Calls = 0.0;
    double Chunks = 0.0; ///< of the largest number of threads

    /** Adds the seconds and the numbers. */
    Phase& operator+=(const Phase& other);
  };

  explicit WorkModel(const ThreadOverhead& overhead = ThreadOverhead());

  /** What comes from now on counts. */
  void Start();

  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override;
  /**
   * In their order; each then begins when what it waits for is done and a thread is free. Threads
   * that find none take parts of others, one by one, after the time of a call.
   */
  bool MakeVisits(const VisitSchedule& schedule, const VisitBody& visit) override;
  void EndPhase(const char* name) override;

  /** In the order in which they ended first. */
  const std::vector<Phase>& Phases() const { return this->Ended; }

private:
  void RunChunks(
    std::size_t n, std::size_t size, const std::function<void(std::size_t, std::size_t)>& body);

  ThreadOverhead Overhead;
  double ClockSeconds; ///< Of the processor, between two readings with nothing in between.
  double Mark = 0.0;   ///< The clock where the serial part began.
  bool IsInside = false;
  std::vector<double> Times; ///< of the chunks of a call
  Phase Present;
  std::vector<Phase> Ended;
};

} // namespace volumic::bench

#endif
