// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicExecutor_h
#define volumicExecutor_h

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

namespace volumic
{
/**
 * Parallel loops on the threads of oneTBB, in an arena that limits how many work at the same time.
 *
 * The bodies write to disjoint locations and reduce in fixed spans. Results therefore do not depend
 * on the chunks nor on the number of threads. Loops may be nested: threads without work of their
 * own take chunks of any loop. A thread that waits for a loop takes chunks of that loop only.
 */
class Executor
{
public:
  /**
   * @param numberOfThreads includes the calling thread. With 1 no thread is created. TBB may supply
   *        fewer, because it has one thread per processor for all arenas of a process.
   */
  explicit Executor(int numberOfThreads = 1);
  virtual ~Executor();

  int NumberOfThreads() const { return this->Number; }

  /**
   * Call `body(begin, end)` on ranges that cover [0, n) exactly once, in any order, on any threads,
   * and return when all calls have ended. The first exception of a body skips the ranges that have
   * not begun and is rethrown on the calling thread.
   * @param grain the number of items under which a chunk is not worth a thread
   */
  virtual void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body);

  /** Call `work` such that TBB's algorithms use these threads. Requires more than one thread. */
  void Execute(const std::function<void()>& work);

protected:
  /** A copy shares the arena. */
  Executor(const Executor& other) = default;
  Executor& operator=(const Executor&) = delete;

private:
  class Arena;

  int Number;
  std::shared_ptr<Arena> Threads; ///< Null for a single thread.
};

/** Return an executor without threads, for small loops. */
inline Executor& OnThisThread()
{
  static Executor executor;
  return executor;
}

/** Call body(span, begin, end) on spans of [0, n) that do not depend on the number of threads. */
template <typename Body>
void ForSpans(Executor& executor, std::size_t n, std::size_t size, Body&& body)
{
  const std::size_t spans = (n + size - 1) / size;
  executor.For(spans, 1,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t b = begin; b < end; ++b)
      {
        body(b, b * size, std::min(n, (b + 1) * size));
      }
    });
}

/** Return the sum of sumOf(begin, end) over spans of [0, n); bit-identical for any executor. */
template <typename SumOf>
double SumOfSpans(Executor& executor, std::size_t n, std::size_t size, SumOf&& sumOf)
{
  std::vector<double> sums((n + size - 1) / size);
  ForSpans(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end) { sums[b] = sumOf(begin, end); });
  return std::accumulate(sums.begin(), sums.end(), 0.);
}
}

#endif
