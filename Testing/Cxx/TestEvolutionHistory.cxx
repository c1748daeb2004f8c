// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SurfaceState.h"
#include "EvolutionTestTools.h"

#include <chrono>

using namespace volumic;

namespace
{
double Known(double x, double y, double z)
{
  // Two balls that need a cut, and a torus that needs a merge.
  const double first = Distance(x, y, z, 12, 12, 20) - 6.5;
  const double second = Distance(x, y, z, 12, 29, 20) - 6.5;
  const double q = Distance(x, y, 0, 28, 20, 0) - 6.;
  return std::min({ first, second, std::sqrt(q * q + (z - 20) * (z - 20)) - 2.6 });
}

LevelPair SceneWithMissedBalls()
{
  const auto fine = [](double x, double y, double z)
  {
    return std::min({ Known(x, y, z), Distance(x, y, z, 20, 20, 5.5) - 2.6,
      Distance(x, y, z, 20, 20, 34) - 2.6 });
  };
  return LevelPair(40, fine, Known);
}

/** @return the number of rows of the coarse level */
std::size_t RunBothLevels(TestEvolution& evolution, const LevelPair& scene)
{
  evolution.StartEnclosing(scene.Coarse.Image, 1);
  evolution.Run();
  const std::size_t coarseRows = evolution.History().size();
  evolution.Divide(scene.Fine.Image, 0);
  evolution.Run();
  return coarseRows;
}
}

TEST(EvolutionHistory, MostVerticesConvergeImmediatelyAfterDivision)
{
  // The divided surface is moved along the finer field first, unless other forces act.
  const auto ball = [](double r)
  { return [r](double x, double y, double z) { return Distance(x, y, z, 16, 16, 16) - r; }; };
  for (const bool alone : { true, false })
  {
    const LevelPair scene(32, ball(11.), ball(10.));
    SurfaceOptions options = IsoHalf();
    options.SnapToIsoValue = alone;
    TestEvolution evolution(options, Threads, Silent);
    const std::size_t coarseRows = RunBothLevels(evolution, scene);
    const std::vector<HistoryRow>& rows = evolution.History();
    const double visits = std::accumulate(rows.begin() + static_cast<std::ptrdiff_t>(coarseRows),
      rows.end(), 0., [](double sum, const HistoryRow& row) { return sum + row.ActiveVertices; });
    const double ofVertex = visits / rows.back().Vertices;
    EXPECT_TRUE(alone ? ofVertex < 1. : ofVertex > 4.) << ofVertex;
  }
}

TEST(EvolutionHistory, LastRowDescribesSurfaceOfLevel)
{
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  std::size_t last = 0; // vertices after the last iteration
  evolution.AfterSweep = [&] { last = evolution.Result().Points.size(); };
  RunBothLevels(evolution, SceneWithMissedBalls());
  const SurfaceResult surface = evolution.Result();
  ASSERT_NE(last, surface.Points.size()) << "otherwise the test is meaningless";
  const SurfaceFeatures features = ComputeFeatures(surface);
  const HistoryRow& row = evolution.History().back();
  EXPECT_EQ(row.Vertices, static_cast<int>(surface.Points.size()));
  EXPECT_EQ(row.EulerCharacteristic, features.EulerCharacteristic);
  EXPECT_EQ(row.Components, static_cast<int>(features.Components.size()));
}

TEST(EvolutionHistory, CountsDeletedComponents)
{
  SurfaceState state;
  state.Mesh.Append(MakeTorus({ 0, 0, 0 }, 8, 3, 24, 10));
  state.Mesh.Append(Icosahedron({ 20, 0, 0 }, 2.));
  state.Reset(Vector(-30, -30, -30), Vector(30, 30, 30));
  ASSERT_EQ(state.EulerCharacteristic, 2);
  state.RemoveComponent(0);
  EXPECT_EQ(state.Counts.Removed, 1);
  EXPECT_EQ(state.EulerCharacteristic, 2);
  state.RemoveComponent(240);
  EXPECT_EQ(state.Counts.Removed, 2);
  EXPECT_EQ(state.EulerCharacteristic, 0);
}

TEST(EvolutionHistory, SecondsAddUpToElapsedTime)
{
  const LevelPair scene = SceneWithMissedBalls();
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  using std::chrono::steady_clock;
  const auto start = steady_clock::now() - std::chrono::seconds(1000);
  const auto elapsed = [start]
  { return std::chrono::duration<double>(steady_clock::now() - start).count(); };
  evolution.Rest.History.StartClock(start);
  evolution.StartEnclosing(scene.Coarse.Image, 1);
  evolution.Run();
  evolution.Rest.History.EndLevel();
  const double coarse = elapsed();
  evolution.Divide(scene.Fine.Image, 0);
  evolution.Run();
  const double most = elapsed();
  evolution.Rest.History.EndLevel();
  const double all = elapsed();
  double sums[2] = { 0., 0. };
  for (const HistoryRow& row : evolution.History())
  {
    EXPECT_GT(row.Seconds, 0.);
    sums[row.Level] += row.Seconds;
  }
  EXPECT_LE(sums[1], coarse);
  EXPECT_GE(sums[0] + sums[1], most) << "no time is missing";
  EXPECT_LE(sums[0] + sums[1], all);
  EXPECT_GE(evolution.History().front().Seconds, 1000.);
  EXPECT_LT(evolution.History()[1].Seconds, 100.) << "only the first row contains the time before";
}
