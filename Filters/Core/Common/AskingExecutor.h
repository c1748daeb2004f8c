// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAskingExecutor_h
#define volumicAskingExecutor_h

#include "Core/Common/Executor.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>

namespace volumic
{
/** What AskingExecutor throws: the run is to stop. */
struct StoppedWork
{
};

/**
 * Has another executor do its work bit by bit, and asks in between, on the calling thread, whether
 * to go on: several times a second, if the work is cut into enough parts. Else it throws
 * StoppedWork, with parts not done. Results do not depend on it.
 */
class AskingExecutor final : public Executor
{
public:
  AskingExecutor(Executor& executor, std::function<bool()> goOn)
    : Inner(executor), GoOn(std::move(goOn))
  {
  }

  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    for (std::size_t first = 0; first < n;)
    {
      const auto start = std::chrono::steady_clock::now();
      const std::size_t count = std::min(this->Batch * std::max<std::size_t>(grain, 1), n - first);
      this->Inner.For(count, grain,
        [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
      first += count;
      if (!this->GoOn())
      {
        throw StoppedWork();
      }
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      this->Batch = taken.count() < Least ? std::min(2 * this->Batch, ManyParts)
        : taken.count() > Most            ? std::max<std::size_t>(this->Batch / 2, FewParts)
                                          : this->Batch;
    }
  }

private:
  static constexpr std::size_t FewParts = 16; ///< enough for threads to share
  static constexpr std::size_t ManyParts = 1 << 20;
  static constexpr double Least = 0.05;       ///< seconds
  static constexpr double Most = 0.2;

  Executor& Inner;
  std::function<bool()> GoOn;
  std::size_t Batch = FewParts;
};
}

#endif
