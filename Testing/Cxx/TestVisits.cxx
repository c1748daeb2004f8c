// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces that are worked on in visits of blocks: whole runs of small scenes.
#include "BarTestScene.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "EvolutionTestTools.h"
#include "MeshInvariants.h"
#include "ThreadTestTools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace volumic;

namespace
{
/** Both levels of the bars in blocks of so many delta. */
SurfaceOptions InBlocksOf(double side)
{
  SurfaceOptions options = IsoHalf();
  options.RecoverCavities = true;
  options.MaximumNumberOfIterations = 60;
  options.BlockSide = side;
  return options;
}

/** Hears all, and says stop after so many questions; 0: never. */
class Listener final : public Monitor
{
public:
  explicit Listener(int most = 0) : Most(most) {}
  bool Continue(const Status& status) override { return this->Hear(status); }
  bool GoOn(const Status& status) override { return this->Hear(status); }

  std::vector<Status> Heard;

private:
  bool Hear(const Status& status)
  {
    this->Heard.push_back(status);
    return static_cast<int>(this->Heard.size()) != this->Most;
  }
  int Most;
};

struct SweptRun
{
  SurfaceResult Surface;
  std::vector<HistoryRow> Rows;
  int Enclosed = 0;

  SweptRun(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
  {
    const TestVolume fine = FineBars();
    const TestVolume coarse = CoarseBars();
    SurfaceEvolution evolution(options, executor, monitor);
    evolution.StartEnclosing(coarse.Image, 1);
    if (evolution.Run() != StopReason::Cancelled && evolution.Divide(fine.Image, 0))
    {
      this->Enclosed = evolution.Lost().Enclosed + evolution.Lost().EnclosedCavities;
      evolution.Run();
    }
    this->Surface = evolution.Result();
    this->Rows = evolution.History();
  }

  SurfaceMesh Mesh() const
  {
    SurfaceMesh mesh;
    mesh.Append(this->Surface);
    return mesh;
  }
};

void ExpectSound(const SweptRun& run)
{
  const SurfaceMesh mesh = run.Mesh();
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(CountSelfIntersections(run.Surface), 0);
  EXPECT_EQ(mesh.CountEulerCharacteristic(), run.Rows.back().EulerCharacteristic);
  EXPECT_EQ(mesh.NumberOfVertices(), run.Rows.back().Vertices);
}
}

TEST(Visits, MakeTheSurfaceOfOneBlock)
{
  SequentialExecutor thread;
  Monitor monitor;
  const SweptRun expected(InBlocksOf(1000.), thread, monitor);
  const double volume = EnclosedVolume(expected.Mesh(), thread);
  for (const double side : { 8., 12., 21. })
  {
    SCOPED_TRACE(side);
    const SweptRun run(InBlocksOf(side), thread, monitor);
    ExpectSound(run);
    EXPECT_NE(run.Surface.Points, expected.Surface.Points) << "not in several blocks";
    EXPECT_NEAR(EnclosedVolume(run.Mesh(), thread), volume, 0.02 * volume);
    EXPECT_NEAR(run.Surface.Points.size(), expected.Surface.Points.size(),
      0.05 * static_cast<double>(expected.Surface.Points.size()));
    // Bars as thick as the mesh's gaps: an iso-value that is .001 higher changes as much.
    EXPECT_NEAR(run.Rows.back().EulerCharacteristic, expected.Rows.back().EulerCharacteristic, 24);
    EXPECT_NEAR(run.Rows.back().Components, expected.Rows.back().Components, 12);
    EXPECT_NEAR(run.Enclosed, expected.Enclosed, 10);
    for (const double edge : EdgeLengths(run.Surface))
    {
      ASSERT_GE(edge, 0.999 * run.Surface.Delta);
      ASSERT_LE(edge, 2.501 * run.Surface.Delta);
    }
  }
}

TEST(Visits, MakeTheSameBitsOnAnyThreads)
{
  const TestVolume plate = Plate(1.);
  const auto hashOf = [&plate](Executor& executor)
  {
    Monitor monitor;
    SurfaceOptions options = IsoHalf();
    options.MaximumNumberOfIterations = 30;
    SurfaceEvolution evolution(options, executor, monitor);
    evolution.StartEnclosing(plate.Image, 0);
    evolution.Run();
    const SurfaceResult surface = evolution.Result();
    std::uint64_t hash = HashOf(surface.Triangles, HashOf(surface.Points));
    for (const HistoryRow& row : evolution.History())
    {
      hash = HashOf(std::vector<double>{ row.KineticEnergy, row.MeanEdgeLength, row.TimeStep,
                      static_cast<double>(row.Vertices), static_cast<double>(row.Flips) },
        hash);
    }
    EXPECT_GT(surface.Points.size(), 10000u);
    return hash;
  };
  SequentialExecutor thread;
  const std::uint64_t alone = hashOf(thread);
  for (const int threads : { 2, 3, 7 })
  {
    DelayedThreads executor(threads, static_cast<unsigned>(threads) * 91, 60, 16);
    EXPECT_EQ(hashOf(executor), alone) << threads << " threads";
  }
}

TEST(Visits, FillARowForEachIteration)
{
  SequentialExecutor thread;
  Monitor monitor;
  const SweptRun run(InBlocksOf(12.), thread, monitor);
  int merges = 0;
  for (std::size_t i = 0; i < run.Rows.size(); ++i)
  {
    const HistoryRow& row = run.Rows[i];
    const int before = i > 0 ? run.Rows[i - 1].EulerCharacteristic : 0;
    EXPECT_EQ(row.Iteration, static_cast<int>(i) + 1);
    EXPECT_EQ(row.IterationEulerCharacteristic,
      before + row.AddedEulerCharacteristic +
        2 * (row.Cuts - row.Merges - row.Deletions + row.DeletedGenus))
      << "row " << i;
    EXPECT_GT(row.Vertices, 0);
    EXPECT_GT(row.TimeStep, 0.);
    EXPECT_GE(row.Seconds, 0.);
    EXPECT_LE(row.ActiveVertices, 2 * row.Vertices);
    merges += row.Merges;
  }
  EXPECT_GT(merges, 3);
  EXPECT_GT(run.Rows.front().KineticEnergy, run.Rows.back().KineticEnergy);
}

TEST(Visits, TellSweepAndBlock)
{
  SequentialExecutor thread;
  Listener listener;
  const SweptRun run(InBlocksOf(12.), thread, listener);
  int sweeps = 0;
  int visits = 0;
  double last = 0.;
  for (const Monitor::Status& status : listener.Heard)
  {
    const double fraction = 1. - status.Level + status.Fraction;
    EXPECT_GE(fraction, last) << "sweep " << status.Sweep << " block " << status.Block;
    last = std::max(last, fraction);
    sweeps = std::max(sweeps, status.Sweep);
    visits += status.Block > 0;
    EXPECT_LE(status.Block, status.Blocks);
  }
  EXPECT_GE(sweeps, 5);
  EXPECT_GT(visits, 50);
}

TEST(Visits, StopBetweenAnyTwoBlocks)
{
  SequentialExecutor thread;
  Listener whole;
  const SweptRun all(InBlocksOf(12.), thread, whole);
  const int questions = static_cast<int>(whole.Heard.size());
  ASSERT_GT(questions, 100);
  for (int last = 7; last < questions; last += questions / 9)
  {
    SCOPED_TRACE("question " + std::to_string(last));
    Listener listener(last);
    const SweptRun run(InBlocksOf(12.), thread, listener);
    EXPECT_EQ(static_cast<int>(listener.Heard.size()), last) << "not asked again";
    const SurfaceMesh mesh = run.Mesh();
    EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
    EXPECT_EQ(CountSelfIntersections(run.Surface), 0);
  }
}

TEST(Visits, FollowASurfaceThatMovesFar)
{
  // From a seed to the whole ball: it goes through many blocks.
  const TestVolume ball = BallVolume(40, 16.);
  SequentialExecutor thread;
  Monitor monitor;
  SurfaceOptions options = InBlocksOf(9.);
  options.MaximumNumberOfIterations = 400;
  SurfaceEvolution evolution(options, thread, monitor);
  evolution.StartSeeds(ball.Image, 0, { { 20., 20., 20. } });
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  SurfaceMesh mesh;
  mesh.Append(evolution.Result());
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
  const double volume = 4. / 3. * std::acos(-1.) * 16. * 16. * 16.;
  EXPECT_NEAR(EnclosedVolume(mesh, thread), volume, 0.02 * volume);
}

TEST(Visits, DeleteWhatVanishesWithinABlock)
{
  // Without an object everything shrinks to nothing.
  const TestVolume empty = MakeVolume(20,
    [](double x, double y, double z) { return Soft(Distance(x, y, z, 10, 10, 10) - 0.3); });
  SequentialExecutor thread;
  Monitor monitor;
  SurfaceOptions options = InBlocksOf(12.);
  options.MaximumNumberOfIterations = 400;
  SurfaceEvolution evolution(options, thread, monitor);
  evolution.StartEnclosing(empty.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::Vanished);
  EXPECT_TRUE(evolution.Result().Points.empty());
  int deletions = 0;
  for (const HistoryRow& row : evolution.History())
  {
    deletions += row.Deletions;
  }
  EXPECT_GE(deletions, 1);
}
