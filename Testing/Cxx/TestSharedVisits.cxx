// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Visits in which threads share that find no visit to make.
#include "Core/Common/StandardThreads.h"
#include "VisitTestTools.h"

#include <atomic>
#include <mutex>

using namespace volumic;

namespace
{
constexpr std::chrono::seconds Patience(20);

/** Items in rows, each of which touches the one before it: so many threads visit at a time. */
VisitSchedule ChainsOf(int n, int rows = 1)
{
  return VisitSchedule(InOrder(n),
    [=](int item)
    {
      std::vector<int> touched = { item - rows, item + rows };
      touched.erase(std::remove_if(touched.begin(), touched.end(),
                      [n](int other) { return other < 0 || other >= n; }),
        touched.end());
      return touched;
    });
}
}

TEST(SharedVisits, ThreadsWithoutAVisitTakePartsOfOthers)
{
  StandardThreads threads(3);
  std::set<std::thread::id> parts;
  std::mutex mutex;
  const auto start = std::chrono::steady_clock::now();
  ChainsOf(1).Run(threads,
    [&](int, std::size_t, Executor& idle)
    {
      // Until others have come: before, it makes all parts itself.
      while (parts.size() < 2 && std::chrono::steady_clock::now() - start < Patience)
      {
        idle.For(12, 1,
          [&](std::size_t, std::size_t)
          {
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            const std::lock_guard<std::mutex> lock(mutex);
            parts.insert(std::this_thread::get_id());
          });
      }
    },
    Always);
  EXPECT_GE(parts.size(), 2u);
}

TEST(SharedVisits, EachPartIsMadeOnceAndBeforeTheVisitGoesOn)
{
  constexpr int visits = 30;
  constexpr std::size_t n = 1000;
  for (const int count : { 1, 2, 5 })
  {
    StandardThreads threads(count);
    std::vector<std::vector<int>> made(visits, std::vector<int>(n, 0));
    std::atomic<int> wrong{ 0 };
    // Two rows, so that more than one visit shares at a time.
    EXPECT_TRUE(ChainsOf(visits, 2).Run(threads,
      [&](int item, std::size_t, Executor& idle)
      {
        std::vector<int>& own = made[item];
        for (int round = 1; round <= 3; ++round)
        {
          idle.For(n, 10,
            [&own](std::size_t begin, std::size_t end)
            {
              std::this_thread::sleep_for(std::chrono::microseconds(50));
              for (std::size_t i = begin; i < end; ++i)
              {
                ++own[i];
              }
            });
          wrong += std::count(own.begin(), own.end(), round) != static_cast<std::ptrdiff_t>(n);
        }
      },
      Always));
    EXPECT_EQ(wrong, 0) << count << " threads";
  }
}

TEST(SharedVisits, WhatAPartThrowsLeavesTheVisit)
{
  for (const int count : { 1, 3 })
  {
    StandardThreads threads(count);
    int caught = 0;
    std::atomic<int> underWay{ 0 };
    EXPECT_THROW(ChainsOf(5).Run(threads,
                   [&](int item, std::size_t, Executor& idle)
                   {
                     try
                     {
                       idle.For(40, 1,
                         [&](std::size_t begin, std::size_t)
                         {
                           ++underWay;
                           std::this_thread::sleep_for(std::chrono::microseconds(300));
                           --underWay;
                           if (item == 2 && begin <= 20)
                           {
                             throw std::runtime_error("part");
                           }
                         });
                     }
                     catch (const std::runtime_error&)
                     {
                       EXPECT_EQ(item, 2);
                       EXPECT_EQ(underWay, 0) << "thrown before other parts were finished";
                       ++caught;
                       throw;
                     }
                   },
                   Always),
      std::runtime_error);
    EXPECT_EQ(caught, 1) << count << " threads";
  }
}
