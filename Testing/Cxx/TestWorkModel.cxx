// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The model of more threads than there are, of Testing/Benchmarks.
#include "TestPrelude.h"
#include "WorkModel.h"

#include <ctime>

using namespace volumic::bench;

namespace
{
/** Work for the processor, which sleep would not be. */
void Work(double seconds)
{
  const std::clock_t end = std::clock() + static_cast<std::clock_t>(seconds * CLOCKS_PER_SEC);
  while (std::clock() < end)
  {
  }
}

using Ranges = std::vector<std::pair<std::size_t, std::size_t>>;
}

TEST(WorkModel, ThreadsTakeChunksInOrderWhenTheyAreFree)
{
  const std::vector<double> chunks = { 3., 1., 1., 1., 4. };
  EXPECT_DOUBLE_EQ(ScheduledSeconds(chunks, 1), 10.);
  // One does the 3, the other the three of 1; then 4 more.
  EXPECT_DOUBLE_EQ(ScheduledSeconds(chunks, 2), 7.);
  EXPECT_DOUBLE_EQ(ScheduledSeconds(chunks, 3), 5.);
  EXPECT_DOUBLE_EQ(ScheduledSeconds(chunks, 64), 4.);
  EXPECT_DOUBLE_EQ(ScheduledSeconds({}, 4), 0.);
  EXPECT_DOUBLE_EQ(ScheduledSeconds(chunks, 2, 0.5), 8.) << "3 and 4 on one, 1, 1, 1 on the other";
}

TEST(WorkModel, FewerThreadsHaveLargerChunks)
{
  // Five chunks of 10 items, the last one of less.
  const std::vector<double> chunks = { 1., 2., 3., 4., 5. };
  EXPECT_EQ(JoinedChunks(chunks, 10, 10), chunks);
  EXPECT_EQ(JoinedChunks(chunks, 10, 20), (std::vector<double>{ 3., 7., 5. }));
  EXPECT_EQ(JoinedChunks(chunks, 10, 25), (std::vector<double>{ 6., 9. }));
  EXPECT_EQ(JoinedChunks(chunks, 10, 100), std::vector<double>{ 15. });
}

TEST(WorkModel, CutsCallsAsThreadsWould)
{
  WorkModel model;
  model.Start();
  Ranges ranges;
  const auto note = [&ranges](std::size_t begin, std::size_t end)
  { ranges.push_back({ begin, end }); };
  model.For(7, 1, note);
  EXPECT_EQ(ranges, (Ranges{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 4 }, { 4, 5 }, { 5, 6 }, { 6, 7 } }));
  ranges.clear();
  model.For(10, 4, note);
  EXPECT_EQ(ranges, (Ranges{ { 0, 4 }, { 4, 8 }, { 8, 10 } }));
  ranges.clear();
  model.For(5120, 3, note);
  EXPECT_EQ(ranges.size(), 512u) << "8 for each of 64 threads";
  ranges.clear();
  model.For(4, 4, note);
  EXPECT_EQ(ranges, (Ranges{ { 0, 4 } }));
  model.For(0, 4, note);
  EXPECT_EQ(ranges.size(), 1u);
  model.EndPhase("all");
  ASSERT_EQ(model.Phases().size(), 1u);
  EXPECT_EQ(model.Phases()[0].Calls, 3.) << "the small ones are none";
  EXPECT_EQ(model.Phases()[0].Chunks, 7. + 3. + 512.);
}

TEST(WorkModel, KnowsWhatIsSerial)
{
  constexpr double step = 0.004;
  WorkModel model;
  model.Start();
  Work(step);
  model.For(2, 1, [](std::size_t, std::size_t) { Work(2 * step); });
  Work(step);
  model.For(1, 1, [](std::size_t, std::size_t) { Work(step); });
  model.EndPhase("first");
  model.For(4, 1,
    [&model](std::size_t, std::size_t)
    { model.For(4, 1, [](std::size_t, std::size_t) { Work(step / 4); }); });
  model.EndPhase("second");
  model.EndPhase("first");
  ASSERT_EQ(model.Phases().size(), 2u) << "of the same name is the same";
  const WorkModel::Phase& first = model.Phases()[0];
  const WorkModel::Phase& second = model.Phases()[1];
  EXPECT_EQ(first.Name, "first");
  EXPECT_GE(first.Serial, 2.9 * step) << "a call without threads included";
  EXPECT_GE(first.Small, 0.9 * step);
  EXPECT_LT(first.Small, first.Serial);
  EXPECT_EQ(second.Small, 0.) << "within a body it is none";
  EXPECT_GE(first.Parallel, 3.9 * step);
  EXPECT_EQ(second.Calls, 1.) << "those within a body are a part of it";
  EXPECT_LT(second.Serial, second.Parallel);
  for (const WorkModel::Phase& phase : model.Phases())
  {
    double before = phase.Parallel + 1e-3;
    for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
    {
      EXPECT_LE(phase.Scheduled[i], before);
      EXPECT_GE(phase.Scheduled[i], phase.Parallel / ModelledThreads[i]);
      before = phase.Scheduled[i];
    }
  }
  EXPECT_GE(first.Scheduled.back(), 1.9 * step) << "no shorter than its longest chunk";
  model.Start();
  EXPECT_TRUE(model.Phases().empty());
}

TEST(WorkModel, AddsWhatThreadsCost)
{
  ThreadOverhead overhead;
  overhead.SecondsOfCall = 100.;
  overhead.SecondsOfChunk = 10.;
  WorkModel model(overhead);
  model.Start();
  model.For(8, 1, [](std::size_t, std::size_t) {});
  model.EndPhase("all");
  EXPECT_NEAR(model.Phases()[0].Scheduled[0], 140., 1.) << "four on each of two";
  EXPECT_NEAR(model.Phases()[0].Scheduled[2], 110., 1.);
  EXPECT_LT(model.Phases()[0].Serial + model.Phases()[0].Parallel, 1.) << "on one thread nothing";
}

TEST(WorkModel, GoesOnAfterAnException)
{
  WorkModel model;
  model.Start();
  EXPECT_THROW(model.For(4, 1, [](std::size_t, std::size_t) { throw std::runtime_error("x"); }),
    std::runtime_error);
  int calls = 0;
  model.For(4, 1, [&calls](std::size_t, std::size_t) { ++calls; });
  EXPECT_EQ(calls, 4);
}
