// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThreadTestTools_h
#define volumicThreadTestTools_h

#include "Core/Common/Executor.h"
#include "TestPrelude.h"

#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace volumic
{
/** Allows more threads than processors. */
inline const tbb::global_control ManyThreads(tbb::global_control::max_allowed_parallelism, 8);

/** Wait for a condition. @return false after a timeout of 20 s */
template <typename Condition>
bool WaitFor(const Condition& condition)
{
  const auto start = std::chrono::steady_clock::now();
  while (!condition())
  {
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(20))
    {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

/** Executor with random delays, so that the order of execution varies. */
class DelayedThreads final : public Executor
{
public:
  /** @param longest delay in microseconds @param every one in so many items is delayed */
  DelayedThreads(int numberOfThreads, unsigned seed, unsigned longest, unsigned every = 1)
    : Executor(numberOfThreads), State(seed), Longest(longest), Every(every)
  {
  }

  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body) override
  {
    this->Executor::For((n + grain - 1) / grain, 1,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t chunk = begin; chunk < end; ++chunk)
        {
          this->Delay();
          body(chunk * grain, std::min(n, (chunk + 1) * grain));
        }
      });
  }

private:
  void Delay()
  {
    const std::uint32_t number = this->State.fetch_add(0x9e3779b9u) * 2654435761u;
    if ((number >> 8) % this->Every == 0)
    {
      std::this_thread::sleep_for(std::chrono::microseconds((number >> 16) % this->Longest));
    }
  }

  std::atomic<std::uint32_t> State;
  unsigned Longest, Every;
};

/** Runs short ranges in reverse order. */
class ScrambledExecutor final : public Executor
{
public:
  explicit ScrambledExecutor(std::size_t chunk) : Chunk(chunk) {}
  void For(
    std::size_t n, std::size_t, const std::function<void(std::size_t, std::size_t)>& body) override
  {
    for (std::size_t end = n; end > 0;)
    {
      const std::size_t begin = end > this->Chunk ? end - this->Chunk : 0;
      body(begin, end);
      end = begin;
    }
  }

private:
  std::size_t Chunk;
};

/** Return the FNV-1a hash of values. */
template <typename Values>
std::uint64_t HashOf(const Values& values, std::uint64_t hash = 1469598103934665603ull)
{
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(values[0]); ++i)
  {
    hash = (hash ^ bytes[i]) * 1099511628211ull;
  }
  return hash;
}
}

#endif
