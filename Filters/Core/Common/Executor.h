// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicExecutor_h
#define volumicExecutor_h

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

namespace volumic
{
/**
 * A parallel for, so that the core needs no threading library of its own.
 *
 * Contract: For() calls `body(begin, end)` on ranges that cover [0, n) exactly once, in any
 * order, on any threads, and returns when all are done. The bodies that the core hands in write
 * to disjoint places only and reduce in fixed spans, so the chunks an implementation chooses
 * never change a result. For() may be called for small n: run those without threads.
 * An exception thrown by `body` must leave For() on the calling thread.
 */
class Executor
{
public:
  virtual ~Executor() = default;

  /** @param grain the number of items under which a chunk is not worth a thread */
  virtual void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) = 0;
};

/** The default: everything on the calling thread, in order. */
class SequentialExecutor final : public Executor
{
public:
  void For(std::size_t n, std::size_t,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    if (n > 0)
    {
      body(0, n);
    }
  }
};

/** For work that is too small for threads, or has none to ask. */
inline Executor& OnThisThread()
{
  static SequentialExecutor executor;
  return executor;
}

/** Runs body(span, begin, end) over fixed spans of [0, n): the same for any executor. */
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

/**
 * The sum of sumOf(begin, end) over fixed spans of [0, n), in their order: the same bits for any
 * executor.
 */
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
