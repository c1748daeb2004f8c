// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"
#include "TestPrelude.h"

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

using namespace volumic;

TEST(StandardThreads, DoEveryItemOnce)
{
  StandardThreads threads(4);
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

TEST(StandardThreads, WorkTogether)
{
  // Each waits for another one: alone, none would get through.
  StandardThreads threads(3);
  std::atomic<int> present{ 0 };
  std::atomic<bool> isLate{ false };
  threads.For(3, 1,
    [&](std::size_t, std::size_t)
    {
      ++present;
      const auto start = std::chrono::steady_clock::now();
      while (present < 3 && !isLate)
      {
        isLate = std::chrono::steady_clock::now() - start > std::chrono::seconds(20);
        std::this_thread::yield();
      }
    });
  EXPECT_FALSE(isLate);
}

TEST(StandardThreads, AreReadyForManyShortCalls)
{
  StandardThreads threads(3);
  std::atomic<long> sum{ 0 };
  for (int call = 0; call < 20000; ++call)
  {
    threads.For(4, 1, [&](std::size_t begin, std::size_t end) { sum += long(end - begin); });
  }
  EXPECT_EQ(sum, 80000);
}

TEST(StandardThreads, HandOnWhatIsThrown)
{
  StandardThreads threads(3);
  for (const std::size_t bad : { 0, 50, 99 })
  {
    const auto body = [bad](std::size_t begin, std::size_t end)
    {
      if (begin <= bad && bad < end)
      {
        throw std::runtime_error("bad " + std::to_string(bad));
      }
    };
    try
    {
      threads.For(100, 1, body);
      FAIL() << "nothing is thrown";
    }
    catch (const std::runtime_error& error)
    {
      EXPECT_EQ(error.what(), "bad " + std::to_string(bad));
    }
  }
  const auto everywhere = [](std::size_t, std::size_t) { throw std::bad_alloc(); };
  EXPECT_THROW(threads.For(100, 1, everywhere), std::bad_alloc);
  std::atomic<int> done{ 0 };
  threads.For(100, 1, [&](std::size_t begin, std::size_t end) { done += int(end - begin); });
  EXPECT_EQ(done, 100) << "they go on after an exception";
}

TEST(StandardThreads, AreTheSameFewAfterEachException)
{
  StandardThreads threads(3);
  std::mutex mutex;
  std::set<std::thread::id> seen;
  int thrown = 0;
  for (std::size_t call = 0; call < 3000; ++call)
  {
    std::atomic<std::size_t> done{ 0 };
    const std::size_t bad = call % 60; // Every other call has such an item.
    const auto body = [&](std::size_t begin, std::size_t end)
    {
      {
        const std::lock_guard<std::mutex> lock(mutex);
        seen.insert(std::this_thread::get_id());
      }
      if (begin <= bad && bad < end)
      {
        throw std::runtime_error("bad");
      }
      done += end - begin;
    };
    try
    {
      threads.For(30, 1, body);
      ASSERT_EQ(done, 30u);
    }
    catch (const std::runtime_error&)
    {
      ++thrown;
    }
  }
  EXPECT_EQ(thrown, 1500);
  EXPECT_LE(seen.size(), 3u);
}

TEST(StandardThreads, DoWhatIsWithinABodyOnItsThread)
{
  StandardThreads threads(3);
  std::atomic<int> done{ 0 };
  std::atomic<int> elsewhere{ 0 };
  threads.For(30, 1,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto id = std::this_thread::get_id();
        threads.For(10, 1,
          [&](std::size_t first, std::size_t last)
          {
            elsewhere += std::this_thread::get_id() != id;
            done += int(last - first);
          });
      }
    });
  EXPECT_EQ(done, 300);
  EXPECT_EQ(elsewhere, 0);
}

namespace
{
/**
 * In a process of its own, as the limit is for the whole process: exits with 0 if all is done all
 * the same, with fewer threads.
 */
[[noreturn]] void RunWithoutMemoryForThreads()
{
  std::size_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r"))
  {
    pages = std::fscanf(file, "%zu", &pages) == 1 ? pages : 0;
    std::fclose(file);
  }
  // Room for the stacks of two threads or three.
  const rlim_t limit = pages * 4096 + 24 * 1024 * 1024;
  const rlimit limits = { limit, limit };
  setrlimit(RLIMIT_AS, &limits);
  StandardThreads threads(64);
  std::atomic<int> done{ 0 };
  threads.For(1000, 1, [&](std::size_t begin, std::size_t end) { done += int(end - begin); });
  const bool isRight = pages > 0 && done == 1000 && threads.NumberOfThreads() < 64;
  std::fprintf(stderr, "%s: %d by %d threads", isRight ? "done with fewer" : "wrong", int(done),
    threads.NumberOfThreads());
  std::_Exit(isRight ? 0 : 1);
}
}

TEST(StandardThreads, MakeDoWithThoseThatTheSystemGives)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more address space than the limit";
#endif
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(RunWithoutMemoryForThreads(), ::testing::ExitedWithCode(0), "done with fewer");
}
