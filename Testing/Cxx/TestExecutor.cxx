// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/CancellableExecutor.h"
#include "ThreadTestTools.h"

#include <mutex>
#include <new>

using namespace volumic;

TEST(Executor, CoversEachItemOnce)
{
  Executor threads(4);
  ASSERT_EQ(threads.NumberOfThreads(), 4);
  for (const std::size_t n : { 0, 1, 3, 100, 12345 })
  {
    for (const std::size_t grain : { 1, 7, 20000 })
    {
      std::vector<std::atomic<int>> done(n);
      threads.For(n, grain,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            ++done[i];
          }
        });
      for (std::size_t i = 0; i < n; ++i)
      {
        ASSERT_EQ(done[i], 1) << i << " of " << n << ", grain " << grain;
      }
    }
  }
}

TEST(Executor, UsesRequestedNumberOfThreads)
{
  for (const std::size_t number : { 1, 3 })
  {
    Executor threads(static_cast<int>(number));
    std::mutex mutex;
    std::set<std::thread::id> seen;
    const auto count = [&]
    {
      const std::lock_guard<std::mutex> lock(mutex);
      seen.insert(std::this_thread::get_id());
      return seen.size();
    };
    // The first items wait for all threads.
    threads.For(
      300, 1, [&](std::size_t, std::size_t) { WaitFor([&] { return count() >= number; }); });
    EXPECT_EQ(seen.size(), number);
  }
}

TEST(Executor, RethrowsExceptionsAndContinues)
{
  Executor threads(3);
  for (const std::size_t bad : { 0, 50, 99 })
  {
    const auto body = [bad](std::size_t begin, std::size_t end)
    {
      if (begin <= bad && bad < end)
      {
        throw std::out_of_range("bad");
      }
    };
    EXPECT_THROW(threads.For(100, 1, body), std::out_of_range);
  }
  const auto everywhere = [](std::size_t, std::size_t) { throw std::bad_alloc(); };
  EXPECT_THROW(threads.For(100, 1, everywhere), std::bad_alloc);
  std::atomic<int> done{ 0 };
  threads.For(100, 1, [&](std::size_t begin, std::size_t end) { done += int(end - begin); });
  EXPECT_EQ(done, 100);
}

TEST(CancellableExecutor, CancelsOnTheCallingThread)
{
  for (const int number : { 1, 3 })
  {
    Executor threads(number);
    const std::thread::id caller = std::this_thread::get_id();
    int queries = 0;
    CancellableExecutor cancellable(threads,
      [&]
      {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        return ++queries < 3;
      });
    constexpr int n = 100000; // more than a test can complete
    std::atomic<int> done{ 0 };
    const auto body = [&](std::size_t begin, std::size_t end)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      done += int(end - begin);
    };
    EXPECT_THROW(cancellable.For(n, 1, body), OperationCancelled);
    EXPECT_EQ(queries, 3);
    EXPECT_GE(done, 3);
    EXPECT_LT(done, n);
  }
}
