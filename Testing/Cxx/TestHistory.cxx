// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
template <typename Value>
long Sum(const std::vector<HistoryRow>& rows, Value HistoryRow::*column)
{
  return std::accumulate(rows.begin(), rows.end(), 0L,
    [column](long sum, const HistoryRow& row) { return sum + static_cast<long>(row.*column); });
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
    evolution.StartEnclosing(volume.Image, 0);
    ASSERT_EQ(evolution.Run(), StopReason::Converged);
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
    const SurfaceFeatures features = ComputeFeatures(surface);
    const HistoryRow& row = evolution.History().back();
    SCOPED_TRACE("sweep " + std::to_string(sweeps));
    EXPECT_EQ(row.Iteration, 5 * sweeps);
    EXPECT_EQ(row.Vertices, static_cast<int>(surface.Points.size()));
    EXPECT_EQ(row.EulerCharacteristic, features.EulerCharacteristic);
    EXPECT_EQ(row.Components, static_cast<int>(features.Components.size()));
    const std::vector<double> lengths = EdgeLengths(surface);
    const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.);
    EXPECT_NEAR(row.MeanEdgeLength, sum / static_cast<double>(lengths.size()), 1e-4);
    EXPECT_TRUE(row.TimeStep > 0 || row.ActiveVertices == 0);
    EXPECT_LE(row.TimeStep, 1.5 + 1e-5);
  };
  evolution.StartEnclosing(volume.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  EXPECT_GT(sweeps, 5);
  const std::vector<HistoryRow>& rows = evolution.History();
  ASSERT_GT(rows.size(), 10u);
  EXPECT_EQ(rows.back().ActiveVertices, 0) << "a level ends without active vertices";
  EXPECT_GT(rows[rows.size() - 6].ActiveVertices, 0) << "at the end of the sweep before";
}

TEST(History, ArrivedVerticesFreezeIfEnabled)
{
  const TestVolume volume = BallVolume(32, 10);
  for (const bool freeze : { true, false })
  {
    SurfaceOptions options = IsoHalf();
    options.FreezeMotionlessVertices = freeze;
    TestEvolution evolution(options, Threads, Silent);
    const auto vertices = [&evolution]() { return evolution.Result().Points.size(); };
    evolution.StartEnclosing(volume.Image, 0);
    const std::size_t first = vertices();
    evolution.Run();
    const std::vector<HistoryRow>& rows = evolution.History();
    EXPECT_EQ(rows.front().ActiveVertices, static_cast<int>(first));
    EXPECT_GT(rows[rows.size() / 4].ActiveVertices, 0.99 * rows[rows.size() / 4].Vertices);
    const SurfaceResult surface = evolution.Result();
    const double motionless =
      std::accumulate(surface.Motionless.begin(), surface.Motionless.end(), 0.) /
      static_cast<double>(vertices());
    const double active = 1. * rows.back().ActiveVertices / rows.back().Vertices;
    if (freeze)
    {
      EXPECT_LT(active, 0.5);
      EXPECT_GT(motionless, 0.5);
    }
    else
    {
      EXPECT_GT(active, 0.99);
      EXPECT_LT(motionless, 0.02);
    }
  }
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
    evolution.StartEnclosing(volume.Image, 0);
    EXPECT_EQ(evolution.Run(), StopReason::Converged);
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
