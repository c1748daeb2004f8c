// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What is known of the time in parallel, and who is told of phases.
#include "Core/Common/MeasuredExecutor.h"
#include "Core/Common/StandardThreads.h"
#include "EvolutionTestTools.h"

#include <chrono>
#include <thread>

using namespace volumic;

namespace
{
constexpr double PauseSeconds = 0.002;

void Pause()
{
  std::this_thread::sleep_for(std::chrono::duration<double>(PauseSeconds));
}

/** Sequential; notes what it is told. */
class NotingExecutor final : public Executor
{
public:
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    this->Grains.push_back(grain);
    body(0, n);
  }
  void EndPhase(const char* name) override { this->Phases.push_back(name); }

  std::vector<std::size_t> Grains;
  std::vector<std::string> Phases;
};
}

TEST(MeasuredExecutor, HandsAllOnAndKeepsTheTimeOfBodies)
{
  NotingExecutor noting;
  MeasuredExecutor executor(noting);
  EXPECT_EQ(noting.SecondsInside(), 0.) << "not measured";
  Pause();
  EXPECT_EQ(executor.SecondsInside(), 0.);
  std::size_t items = 0;
  executor.For(7, 3,
    [&](std::size_t begin, std::size_t end)
    {
      items += end - begin;
      Pause();
    });
  EXPECT_EQ(items, 7u);
  EXPECT_EQ(noting.Grains, std::vector<std::size_t>{ 3 });
  const double seconds = executor.SecondsInside();
  EXPECT_GE(seconds, PauseSeconds);
  Pause();
  EXPECT_EQ(executor.SecondsInside(), seconds) << "what is outside does not count";
  executor.EndPhase("first");
  EXPECT_EQ(noting.Phases, std::vector<std::string>{ "first" });
}

TEST(MeasuredExecutor, CountsWhatIsWithinABodyOnce)
{
  StandardThreads threads(2);
  MeasuredExecutor executor(threads);
  executor.For(8, 1,
    [&](std::size_t, std::size_t)
    {
      executor.For(2, 1, [](std::size_t, std::size_t) { Pause(); });
      EXPECT_EQ(executor.SecondsInside(), 0.) << "with the call about it, when that has ended";
    });
  EXPECT_GE(executor.SecondsInside(), PauseSeconds);
}

TEST(MeasuredExecutor, CountsOnAfterAnException)
{
  SequentialExecutor sequential;
  MeasuredExecutor executor(sequential);
  EXPECT_THROW(
    executor.For(1, 1,
      [](std::size_t, std::size_t)
      {
        Pause();
        throw std::runtime_error("on purpose");
      }),
    std::runtime_error);
  const double seconds = executor.SecondsInside();
  EXPECT_GE(seconds, PauseSeconds);
  executor.For(1, 1, [](std::size_t, std::size_t) { Pause(); });
  EXPECT_GE(executor.SecondsInside(), seconds + PauseSeconds);
}

TEST(MeasuredExecutor, LetsTheHistoryTellWhatOneThreadDoesAlone)
{
  const TestVolume volume = BallVolume(28, 7);
  NotingExecutor noting;
  MeasuredExecutor executor(noting);
  Monitor silent;
  SurfaceEvolution evolution(IsoHalf(), executor, silent);
  evolution.StartEnclosing(volume.Image, 0);
  evolution.Run();
  PhaseTime sum;
  for (const HistoryRow& row : evolution.History())
  {
    for (const PhaseTime& time : row.Phases)
    {
      EXPECT_LE(time.Serial, time.Seconds);
      sum.Seconds += time.Seconds;
      sum.Serial += time.Serial;
    }
  }
  EXPECT_GT(sum.Serial, 0.);
  EXPECT_GT(sum.Seconds - sum.Serial, 0.5 * executor.SecondsInside())
    << "but for little all of it is in a phase";
  EXPECT_LE(sum.Seconds - sum.Serial, executor.SecondsInside() + 1e-9);
  const auto times = [&noting](const char* name)
  { return std::count(noting.Phases.begin(), noting.Phases.end(), name); };
  EXPECT_GT(times("Visits"), 5);
  EXPECT_GT(times("Components"), 5);
  EXPECT_GT(times("Regularisation"), 0);
}

TEST(MeasuredExecutor, IsNeededToTellThem)
{
  const TestVolume volume = BallVolume(28, 7);
  SequentialExecutor sequential;
  Monitor silent;
  SurfaceEvolution evolution(IsoHalf(), sequential, silent);
  evolution.StartEnclosing(volume.Image, 0);
  evolution.Run();
  for (const HistoryRow& row : evolution.History())
  {
    for (const PhaseTime& time : row.Phases)
    {
      EXPECT_EQ(time.Serial, time.Seconds);
    }
  }
}
