// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAskingExecutor_h
#define volumicAskingExecutor_h

#include "Core/Common/Executor.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace volumic
{
/** What AskingExecutor throws to cancel a run. */
struct StoppedWork
{
};

/**
 * Check for cancellation within the loops of another executor, several times a second, on the thread
 * that has constructed it. If `goOn` returns false, For() throws StoppedWork and skips what has not
 * begun. Results do not depend on it.
 */
class AskingExecutor final : public Executor
{
public:
  AskingExecutor(Executor& executor, std::function<bool()> goOn)
    : Executor(executor)
    , Inner(executor)
    , GoOn(std::move(goOn))
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
        if (std::this_thread::get_id() == this->Caller)
        {
          this->Ask();
        }
      });
  }

private:
  using Clock = std::chrono::steady_clock;

  void Ask()
  {
    const Clock::time_point now = Clock::now();
    if (now - this->Last >= std::chrono::milliseconds(100))
    {
      this->Last = now;
      if (!this->GoOn())
      {
        this->IsStopped = true;
        throw StoppedWork();
      }
    }
  }

  Executor& Inner;
  std::function<bool()> GoOn;
  std::thread::id Caller = std::this_thread::get_id();
  Clock::time_point Last = Clock::now();
  std::atomic<bool> IsStopped{ false };
};
}

#endif
