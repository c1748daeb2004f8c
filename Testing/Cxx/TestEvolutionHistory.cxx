// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SurfaceState.h"
#include "EvolutionTestTools.h"

#include <chrono>
#include <cstddef>
#include <numeric>

using namespace volumic;

namespace
{
double Known(double x, double y, double z)
{
  // Two balls, so that there is a cut, and a ring whose hole opens.
  const double first = Distance(x, y, z, 12, 12, 20) - 6.5;
  const double second = Distance(x, y, z, 12, 29, 20) - 6.5;
  const double q = Distance(x, y, 0, 28, 20, 0) - 6.;
  return std::min({ first, second, std::sqrt(q * q + (z - 20) * (z - 20)) - 2.6 });
}

LevelPair SceneWithLostBalls()
{
  const auto fine = [](double x, double y, double z)
  {
    return std::min({ Known(x, y, z), Distance(x, y, z, 20, 20, 5.5) - 2.6,
      Distance(x, y, z, 20, 20, 34) - 2.6 });
  };
  return LevelPair(40, fine, Known);
}

/** Every row is explained by its columns. */
void ExpectExplained(const std::vector<HistoryRow>& rows)
{
  int before = 0;
  for (const HistoryRow& row : rows)
  {
    SCOPED_TRACE("row " + std::to_string(row.Iteration));
    EXPECT_EQ(row.IterationEulerCharacteristic,
      before + row.AddedEulerCharacteristic +
        2 * (row.Cuts - row.Merges - row.Deletions + row.DeletedGenus));
    EXPECT_EQ(row.EulerCharacteristic,
      row.IterationEulerCharacteristic +
        2 * (row.RegularisationCuts - row.RegularisationDeletions));
    const bool isFirstOfLevel = row.Iteration == 1 || rows[row.Iteration - 2].Level != row.Level;
    if (!isFirstOfLevel)
    {
      EXPECT_EQ(row.AddedEulerCharacteristic, 0) << "nothing is added within a level";
      EXPECT_EQ(row.Recovered, 0);
    }
    before = row.EulerCharacteristic;
  }
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

TEST(EvolutionHistory, NewVerticesOnASmoothObjectHardlyMoveAfterADivision)
{
  // The finer field has been descended before it, so that most vertices rest at once, whatever the
  // coarse image has blurred; where other forces drive, nobody knows where to.
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

TEST(EvolutionHistory, ExplainsTheEulerCharacteristicRowByRow)
{
  const LevelPair scene = SceneWithLostBalls();
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  const std::size_t coarseRows = RunBothLevels(evolution, scene);
  const std::vector<HistoryRow>& rows = evolution.History();
  ExpectExplained(rows);
  EXPECT_EQ(rows.front().AddedEulerCharacteristic, 2) << "one body about the image";
  ASSERT_GT(rows.size(), coarseRows);
  EXPECT_EQ(rows[coarseRows].Recovered, 2);
  EXPECT_EQ(rows[coarseRows].AddedEulerCharacteristic, 4) << "two balls about the lost ones";
  int cuts = 0;
  for (const HistoryRow& row : rows)
  {
    cuts += row.Cuts + row.RegularisationCuts;
  }
  EXPECT_GE(cuts, 2) << "otherwise this test would show little";
  const SurfaceFeatures features = ComputeFeatures(evolution.Result());
  EXPECT_EQ(rows.back().EulerCharacteristic, features.EulerCharacteristic);
  EXPECT_EQ(rows.back().Components, static_cast<int>(features.Components.size()));
}

TEST(EvolutionHistory, TellsOfDeletedComponents)
{
  // Seeds in specks too small for them shrink to nothing.
  const TestVolume volume = MakeVolume(40,
    [](double x, double y, double z)
    {
      return Soft(std::min({ Distance(x, y, z, 20, 20, 20) - 8., Distance(x, y, z, 6, 6, 6) - 1.,
        Distance(x, y, z, 33, 33, 33) - 1. }));
    });
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  ASSERT_EQ(
    evolution.StartSeeds(volume.Image, 0, { { 20, 20, 20 }, { 6, 6, 6 }, { 33, 33, 33 } }), 3);
  evolution.Run();
  ExpectExplained(evolution.History());
  int deletions = 0;
  for (const HistoryRow& row : evolution.History())
  {
    deletions += row.Deletions;
    EXPECT_EQ(row.DeletedGenus, 0);
  }
  EXPECT_EQ(deletions, 2);
  EXPECT_EQ(evolution.History().front().AddedEulerCharacteristic, 6);
  EXPECT_EQ(evolution.History().back().Components, 1);
}

TEST(EvolutionHistory, CountsTheHandlesOfADeletedComponent)
{
  SurfaceState state;
  state.Mesh.Append(MakeTorus({ 0, 0, 0 }, 8, 3, 24, 10));
  state.Mesh.Append(Icosahedron({ 20, 0, 0 }, 2.));
  state.Reset(Vector(-30, -30, -30), Vector(30, 30, 30));
  ASSERT_EQ(state.EulerCharacteristic, 2);
  state.RemoveComponent(0);
  EXPECT_EQ(state.Counts.Removed, 1);
  EXPECT_EQ(state.Counts.RemovedGenus, 1);
  EXPECT_EQ(state.EulerCharacteristic, 2);
  state.RemoveComponent(240);
  EXPECT_EQ(state.Counts.Removed, 2);
  EXPECT_EQ(state.Counts.RemovedGenus, 1);
  EXPECT_EQ(state.EulerCharacteristic, 0);
}

TEST(EvolutionHistory, LastRowTellsWhatTheIterationsLeftAndWhatTheRegularisationMadeOfIt)
{
  const LevelPair scene = SceneWithLostBalls();
  std::size_t last = 0; // Vertices after the last iteration.
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  evolution.AfterSweep = [&] { last = evolution.Result().Points.size(); };
  evolution.StartEnclosing(scene.Coarse.Image, 1);
  evolution.Run();
  const HistoryRow row = evolution.History().back();
  const std::size_t regularised = evolution.Result().Points.size();
  ASSERT_NE(last, regularised) << "otherwise this test would show nothing";
  EXPECT_EQ(row.IterationVertices, static_cast<int>(last));
  EXPECT_EQ(row.Vertices, static_cast<int>(regularised));
  EXPECT_NE(row.MeanEdgeLength, row.IterationMeanEdgeLength);
  const HistoryRow& other = evolution.History()[evolution.History().size() - 2];
  EXPECT_EQ(other.Vertices, other.IterationVertices);
  EXPECT_EQ(other.MeanEdgeLength, other.IterationMeanEdgeLength);
}

TEST(EvolutionHistory, SecondsOfTheRowsAddUpToThoseOfTheLevels)
{
  const LevelPair scene = SceneWithLostBalls();
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
    EXPECT_GE(row.SecondsBefore, 0.);
    EXPECT_GT(row.Seconds, 0.);
    sums[row.Level] += row.SecondsBefore + row.Seconds + row.SecondsAfter;
  }
  EXPECT_LE(sums[1], coarse);
  EXPECT_GE(sums[0] + sums[1], most) << "no second is lost";
  EXPECT_LE(sums[0] + sums[1], all);
  EXPECT_GE(evolution.History().front().SecondsBefore, 1000.);
  EXPECT_EQ(evolution.History()[1].SecondsAfter, 0.) << "only after the last of a level";
  EXPECT_GT(evolution.History().back().SecondsAfter, 0.);
}

TEST(EvolutionHistory, PhasesFitIntoTheSecondsOfTheirRow)
{
  const LevelPair scene = SceneWithLostBalls();
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  evolution.StartEnclosing(scene.Coarse.Image, 1);
  evolution.Run();
  evolution.Rest.History.EndLevel();
  evolution.Divide(scene.Fine.Image, 0);
  evolution.Run();
  evolution.Rest.History.EndLevel();
  const std::vector<HistoryRow>& rows = evolution.History();
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    SCOPED_TRACE("row " + std::to_string(r));
    const auto seconds = [&row = rows[r]](Phase phase)
    { return row.PhaseSeconds[static_cast<int>(phase)]; };
    double inside = 0.;
    for (int p = 0; p < static_cast<int>(Phase::Division); ++p)
    {
      inside += seconds(static_cast<Phase>(p));
    }
    EXPECT_LE(inside, rows[r].Seconds);
    const bool isFirst = r == 0 || rows[r - 1].Level != rows[r].Level;
    const bool isLast = r + 1 == rows.size() || rows[r + 1].Level != rows[r].Level;
    EXPECT_EQ(seconds(Phase::Division) > 0., isFirst);
    EXPECT_EQ(seconds(Phase::Recovery) > 0., (isFirst && r > 0) || isLast);
    EXPECT_EQ(seconds(Phase::Regularisation) > 0., isLast);
    EXPECT_LE(
      seconds(Phase::Division) + seconds(Phase::Recovery) + seconds(Phase::Regularisation),
      rows[r].SecondsBefore + rows[r].SecondsAfter + 1e-9);
  }
}
