// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Whole runs by several threads that are held up by chance: the same surface, the same history.
#include "BarTestScene.h"
#include "Core/Surface/SurfaceState.h"
#include "EvolutionTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
struct Outcome
{
  std::uint64_t Surface;
  EditCounts Edits;
  int Enclosed;
};

Outcome Evolve(Executor& executor)
{
  const TestVolume fine = FineBars();
  const TestVolume coarse = CoarseBars();
  SurfaceOptions options = IsoHalf();
  options.RecoverLostParts = true;
  options.RecoverCavities = true;
  options.MaximumNumberOfIterations = 60;
  Monitor monitor;
  SurfaceEvolution evolution(options, executor, monitor);
  evolution.StartEnclosing(coarse.Image, 1);
  evolution.Run();
  evolution.Divide(fine.Image, 0);
  Outcome outcome;
  outcome.Enclosed = evolution.Lost().Enclosed + evolution.Lost().EnclosedCavities;
  evolution.Run();
  const SurfaceResult result = evolution.Result();
  outcome.Surface = HashOf(result.Triangles, HashOf(result.Points));
  for (const HistoryRow& row : evolution.History())
  {
    outcome.Edits.Merges += row.Merges;
    outcome.Edits.Cuts += row.Cuts;
    outcome.Edits.Splits += row.Splits;
    outcome.Edits.Collapses += row.Collapses;
    const std::vector<double> figures = { row.KineticEnergy, row.MeanEdgeLength, row.TimeStep,
      static_cast<double>(row.Vertices), static_cast<double>(row.EulerCharacteristic) };
    outcome.Surface = HashOf(figures, outcome.Surface);
  }
  return outcome;
}
}

TEST(EveryThread, MakesTheSameRun)
{
  SequentialExecutor thread;
  const Outcome alone = Evolve(thread);
  // It does all that there is to do.
  EXPECT_GT(alone.Edits.Merges, 3);
  EXPECT_GT(alone.Edits.Cuts, 3);
  EXPECT_GT(alone.Edits.Splits, 100);
  EXPECT_GT(alone.Edits.Collapses, 100);
  EXPECT_GT(alone.Enclosed, 0);
  for (const int threads : { 2, 3, 4, 7 })
  {
    DelayedThreads executor(threads, static_cast<unsigned>(threads) * 77, 60, 16);
    const Outcome together = Evolve(executor);
    EXPECT_EQ(together.Surface, alone.Surface) << threads << " threads";
  }
}
