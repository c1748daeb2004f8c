// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCancellableExecutor_h
#define volumicCancellableExecutor_h

#include "Core/Common/Executor.h"

#include <atomic>
#include <thread>
#include <utility>

namespace volumic
{
/** Thrown by CancellableExecutor to cancel a run. */
struct OperationCancelled
{
};

/**
 * Executor that tests for cancellation within the loops of another executor, after each chunk of
 * the constructing thread. If `goOn` returns false, For() skips the remaining chunks and throws
 * OperationCancelled. Otherwise results are those of the other executor.
 */
class CancellableExecutor final : public Executor
{
public:
  CancellableExecutor(Executor& executor, std::function<bool()> goOn)
    : Executor(executor), Inner(executor), GoOn(std::move(goOn))
  {
  }

  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    ForSpans(this->Inner, n, std::max<std::size_t>(grain, 1),
      [&](std::size_t, std::size_t begin, std::size_t end)
      {
        if (this->IsStopped)
        {
          return;
        }
        body(begin, end);
        if (std::this_thread::get_id() == this->Caller && !this->GoOn())
        {
          this->IsStopped = true;
          throw OperationCancelled();
        }
      });
  }

private:
  Executor& Inner;
  std::function<bool()> GoOn;
  std::thread::id Caller = std::this_thread::get_id();
  std::atomic<bool> IsStopped{ false };
};
}

#endif
