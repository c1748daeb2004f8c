// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicExecutor_h
#define volumicExecutor_h

#include <cstddef>
#include <functional>

namespace volumic
{
/**
 * A parallel for, so that the core needs no threading library of its own.
 *
 * Contract: For() calls `body(begin, end)` on ranges that cover [0, n) exactly once, in any
 * order, on any threads, and returns when all are done. The bodies that the core hands in write
 * to disjoint places only and reduce in fixed blocks, so the chunks an implementation chooses
 * never change a result. For() may be called for small n: run those without threads.
 * An exception thrown by `body` must leave For() on the calling thread.
 */
class Executor
{
public:
  virtual ~Executor() = default;

  /** `grain`: number of items under which a chunk is not worth a thread. */
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
}

#endif
