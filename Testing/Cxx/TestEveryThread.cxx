// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Whole runs by several threads that are held up by chance: the same surface, the same history.
#include "Core/Surface/SurfaceState.h"
#include "EvolutionTestTools.h"
#include "ThreadTestTools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

using namespace volumic;

namespace
{
/** A lattice of bars, thick and thin: merges, cuts, lost parts and cavities. */
double Bars(double x, double y, double z)
{
  const auto distance = [](double t) { return std::abs(std::remainder(t, 14.)); };
  const double u = distance(x - 3);
  const double v = distance(y - 3);
  const double w = distance(z - 3);
  const double thick = std::min({ std::hypot(u, v), std::hypot(v, w), std::hypot(u, w) });
  const double hollow = 2.6 - Distance(x, y, z, 24, 24, 24);
  const double outside = std::max({ std::abs(x - 24), std::abs(y - 24), std::abs(z - 24) }) - 20;
  return std::max({ thick - 2.1 - 0.8 * std::sin(0.3 * x), hollow, outside });
}

struct Outcome
{
  std::uint64_t Surface;
  EditCounts Edits;
  int Enclosed;
};

Outcome Evolve(Executor& executor)
{
  const TestVolume fine = MakeVolume(
    48, [](double x, double y, double z) { return Soft(Bars(x, y, z)); });
  TestVolume coarse = MakeVolume(27,
    [](double x, double y, double z)
    {
      constexpr double f = 48. / 27;
      return Soft(Bars(x * f, y * f, z * f) / f);
    });
  coarse.Image.Step = { 48. / 27, 48. / 27, 48. / 27 };
  coarse.Image.Unit = std::sqrt(3.);
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
