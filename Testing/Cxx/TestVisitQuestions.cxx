// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Whether visits are to go on is asked, by the calling thread.
#include "Core/Common/StandardThreads.h"
#include "VisitTestTools.h"

#include <atomic>

using namespace volumic;

TEST(VisitSchedule, AsksWhileOthersAreInLongVisits)
{
  // Another thread makes the one visit that there is, until the host has been asked twice.
  std::atomic<bool> hasBegun{ false };
  std::atomic<int> questions{ 0 };
  ToldExecutor waiting(
    [&](std::size_t n, const Body& body)
    {
      std::thread other([&] { body(0, 1); });
      HasCome([&] { return hasBegun.load(); });
      body(1, n);
      other.join();
    });
  bool areAsked = false;
  EXPECT_TRUE(Apart(1).Run(waiting,
    [&](int, std::size_t, Executor&)
    {
      hasBegun = true;
      areAsked = HasCome([&] { return questions >= 2; });
    },
    [&](std::size_t) { return ++questions > 0; }));
  EXPECT_TRUE(areAsked);
}

TEST(VisitSchedule, EndsSoonWhereItIsToldOnThreads)
{
  constexpr int n = 50000; // More than can be made before it is told, on a machine however slow.
  const VisitSchedule schedule = Apart(n);
  StandardThreads standard(4);
  ToldExecutor other(OnAnotherThread);
  for (Executor* executor : std::initializer_list<Executor*>{ &standard, &other })
  {
    std::atomic<int> visits{ 0 };
    std::atomic<int> underWay{ 0 };
    int asked = 0;
    EXPECT_FALSE(schedule.Run(*executor,
      [&](int, std::size_t, Executor&)
      {
        ++visits;
        ++underWay;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --underWay;
      },
      [&asked](std::size_t) { return ++asked < 3; }));
    EXPECT_EQ(asked, 3) << "not asked again";
    EXPECT_EQ(underWay, 0);
    EXPECT_GE(visits, 3);
    EXPECT_LT(visits, n);
  }
}

TEST(VisitSchedule, AsksOnTheCallingThreadAlone)
{
  constexpr int n = 300;
  const VisitSchedule schedule = Apart(n);
  StandardThreads standard(5);
  ToldExecutor other(OnAnotherThread);
  const std::thread::id caller = std::this_thread::get_id();
  for (Executor* executor : std::initializer_list<Executor*>{ &standard, &other })
  {
    int asked = 0;
    int elsewhere = 0;
    std::size_t most = 0;
    EXPECT_TRUE(schedule.Run(*executor,
      [](int, std::size_t, Executor&) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); },
      [&](std::size_t done)
      {
        ++asked;
        elsewhere += std::this_thread::get_id() != caller;
        EXPECT_GE(done, most);
        most = done;
        return true;
      }));
    EXPECT_GE(asked, 2) << "several times a second";
    EXPECT_EQ(elsewhere, 0);
    EXPECT_LE(most, static_cast<std::size_t>(n));
  }
  EXPECT_GT(other.Calls, 2) << "rounds, between which it is asked";
}
