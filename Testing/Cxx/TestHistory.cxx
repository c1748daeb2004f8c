// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

#include <chrono>

using namespace volumic;

namespace
{
template <typename Value>
long Sum(const std::vector<HistoryRow>& rows, Value HistoryRow::*column)
{
  return std::accumulate(rows.begin(), rows.end(), 0L,
    [column](long sum, const HistoryRow& row) { return sum + static_cast<long>(row.*column); });
}

void ExpectDescribes(const HistoryRow& row, const SurfaceResult& surface)
{
  const SurfaceFeatures features = ComputeFeatures(surface);
  EXPECT_EQ(row.Vertices, static_cast<int>(surface.Points.size()));
  EXPECT_EQ(row.EulerCharacteristic, features.EulerCharacteristic);
  EXPECT_EQ(row.Components, static_cast<int>(features.Components.size()));
}
}

TEST(History, KineticEnergyMatchesTerminalSpeedAndVanishes)
{
  const TestVolume volume = BallVolume(40, 8);
  for (const double friction : { 3., 5. })
  {
    SurfaceOptions options = IsoHalf();
    options.Friction = friction;
    TestEvolution evolution(options, Threads, Silent);
    ASSERT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
    const std::vector<HistoryRow>& rows = evolution.History();
    ASSERT_GT(rows.size(), 40u);
    // Forces and friction balance before the surface reaches the object.
    const double speed = evolution.Result().Delta / friction;
    EXPECT_NEAR(rows[20].KineticEnergy, 0.5 * speed * speed, 0.05 * speed * speed);
    EXPECT_LT(rows.back().KineticEnergy, 0.01 * speed * speed);
    EXPECT_LE(rows[20].TimeStep, 0.5 * friction * (1 + 1e-5));
    EXPECT_GT(rows[20].TimeStep, 0.4 * friction) << "edges of the box are slightly faster";
  }
}

TEST(History, RowsDescribeStateAfterSweep)
{
  const TestVolume volume = BallVolume(28, 7);
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  int sweeps = 0;
  evolution.AfterSweep = [&]
  {
    ++sweeps;
    const SurfaceResult surface = evolution.Result();
    const HistoryRow& row = evolution.History().back();
    SCOPED_TRACE("sweep " + std::to_string(sweeps));
    EXPECT_EQ(row.Iteration, 5 * sweeps);
    ExpectDescribes(row, surface);
    double sum = 0;
    VisitEdges(surface, [&sum](int, int, double length) { sum += length; });
    EXPECT_NEAR(row.MeanEdgeLength, sum / (3. * surface.Triangles.size()), 1e-4);
    EXPECT_TRUE(row.TimeStep > 0 || row.ActiveVertices == 0);
    const auto active = std::count(surface.Motionless.begin(), surface.Motionless.end(), 0);
    EXPECT_LE(active, row.ActiveVertices) << "others have frozen in the last iteration";
    EXPECT_GE(active, 0.3 * row.ActiveVertices);
    EXPECT_LE(row.TimeStep, 1.5 + 1e-5);
  };
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
  EXPECT_GT(sweeps, 5);
  const std::vector<HistoryRow>& rows = evolution.History();
  ASSERT_GT(rows.size(), 10u);
  EXPECT_EQ(rows.back().ActiveVertices, 0) << "a level ends without active vertices";
  EXPECT_GT(rows[rows.size() - 6].ActiveVertices, 0) << "at the end of the sweep before";
}

TEST(History, EditCountsExplainTopology)
{
  const TestVolume volume = MakeVolume(40,
    [](double x, double y, double z)
    {
      const double q = std::sqrt((x - 20) * (x - 20) + (y - 20) * (y - 20)) - 11;
      return Soft(std::sqrt(q * q + (z - 20) * (z - 20)) - 5);
    });
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  evolution.StartSeeds(volume.Image, 0, { { 9, 20, 20 }, { 31, 20, 20 } });
  const std::size_t start = evolution.Result().Points.size();
  evolution.Run();
  const std::vector<HistoryRow>& rows = evolution.History();
  EXPECT_EQ(4 + 2 * (Sum(rows, &HistoryRow::Cuts) - Sum(rows, &HistoryRow::Merges)), 0);
  EXPECT_GE(Sum(rows, &HistoryRow::Merges), 2);
  EXPECT_EQ(ComputeFeatures(evolution.Result()).Genus, 1);
  // A merge removes two vertices.
  const long explained = static_cast<long>(start) + Sum(rows, &HistoryRow::Splits) -
    Sum(rows, &HistoryRow::Collapses) - 2 * Sum(rows, &HistoryRow::Merges) +
    3 * Sum(rows, &HistoryRow::Cuts);
  long last = 0;
  for (const HistoryRow& row : rows)
  {
    EXPECT_LE(row.ActiveVertices, row.Vertices + row.Collapses + 2 * row.Merges);
    last = row.Vertices;
  }
  // The final optimization makes edits that no row counts.
  EXPECT_NEAR(explained, last, 0.1 * last);
  EXPECT_GT(Sum(rows, &HistoryRow::Flips), 50);
}

TEST(History, LevelConvergesWithItsVolume)
{
  const TestVolume volume = BallVolume(32, 10);
  std::vector<std::size_t> iterations;
  for (const double tolerance : { 0.05, 5e-4, 0. })
  {
    SurfaceOptions options = IsoHalf();
    options.ConvergenceTolerance = tolerance;
    options.FreezeMotionlessVertices = false; // else the level ends without active vertices
    std::vector<double> volumes;
    TestEvolution evolution(options, Threads, Silent);
    evolution.AfterSweep = [&] { volumes.push_back(ComputeFeatures(evolution.Result()).Volume); };
    EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
    const double delta = evolution.Result().Delta;
    // As documented at SurfaceOptions::ConvergenceTolerance.
    std::size_t expected = 5;
    for (; expected < volumes.size(); ++expected)
    {
      const double last = volumes[expected - 1];
      const double limit = std::max(delta * delta * delta, tolerance * last);
      if (std::abs(last - volumes[expected - 3]) < limit &&
        std::abs(last - volumes[expected - 5]) < limit)
      {
        break;
      }
    }
    EXPECT_EQ(volumes.size(), expected) << "tolerance " << tolerance;
    iterations.push_back(volumes.size());
  }
  EXPECT_LT(iterations.front(), iterations.back());
}

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
  evolution.RunEnclosing(scene.Coarse.Image, 1);
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
  const LevelPair scene = SceneWithMissedBalls();
  RunBothLevels(evolution, scene);
  ASSERT_NE(last, evolution.Result().Points.size()) << "otherwise the test is meaningless";
  ExpectDescribes(evolution.History().back(), evolution.Result());
}

TEST(EvolutionHistory, SecondsAddUpToElapsedTime)
{
  const LevelPair scene = SceneWithMissedBalls();
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  using std::chrono::steady_clock;
  const auto start = steady_clock::now() - std::chrono::seconds(1000);
  const auto elapsed = [start]
  { return std::chrono::duration<double>(steady_clock::now() - start).count(); };
  evolution.Converged.History.StartClock(start);
  evolution.RunEnclosing(scene.Coarse.Image, 1);
  evolution.Converged.History.EndLevel();
  const double coarse = elapsed();
  evolution.Divide(scene.Fine.Image, 0);
  evolution.Run();
  const double most = elapsed();
  evolution.Converged.History.EndLevel();
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
