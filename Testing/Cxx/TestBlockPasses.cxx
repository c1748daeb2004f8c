// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Evolution in block passes: complete runs of small scenes.
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "EvolutionTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
/** A lattice of bars that needs merges, cuts and recovery. */
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

/** @param side of a block in delta; 0: default */
SurfaceOptions InBlocksOf(double side)
{
  SurfaceOptions options = IsoHalf();
  options.RecoverCavities = true;
  options.MaximumNumberOfIterations = 60;
  options.BlockSide = side;
  return options;
}

struct SweptRun
{
  SurfaceResult Surface;
  std::vector<HistoryRow> Rows;
  int Enclosed = 0;

  SweptRun(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
  {
    const LevelPair scene(48, Bars, Bars);
    TestEvolution evolution(options, executor, monitor);
    if (evolution.RunEnclosing(scene.Coarse.Image, 1) != StopReason::Cancelled &&
      evolution.Divide(scene.Fine.Image, 0))
    {
      this->Enclosed = evolution.Missed().Enclosed + evolution.Missed().EnclosedCavities;
      evolution.Run();
    }
    this->Surface = evolution.Result();
    this->Rows = evolution.History();
  }
};

void ExpectValid(const SweptRun& run)
{
  ExpectValidMesh(run.Surface);
  const SurfaceMesh mesh = MeshOf(run.Surface);
  EXPECT_EQ(mesh.CountEulerCharacteristic(), run.Rows.back().EulerCharacteristic);
  EXPECT_EQ(mesh.NumberOfVertices(), run.Rows.back().Vertices);
}
}

TEST(Passes, GiveSameSurfaceForAnyBlockSize)
{
  Executor thread;
  Monitor monitor;
  const SweptRun expected(InBlocksOf(1000.), thread, monitor);
  const double volume = EnclosedVolume(MeshOf(expected.Surface), thread);
  for (const double side : { 8., 12., 21. })
  {
    SCOPED_TRACE(side);
    const SweptRun run(InBlocksOf(side), thread, monitor);
    ExpectValid(run);
    EXPECT_NE(run.Surface.Points, expected.Surface.Points) << "several blocks";
    EXPECT_NEAR(EnclosedVolume(MeshOf(run.Surface), thread), volume, 0.07 * volume);
    EXPECT_NEAR(run.Surface.Points.size(), expected.Surface.Points.size(),
      0.07 * static_cast<double>(expected.Surface.Points.size()));
    // A change of the iso-value by .001 has the same effect, as the bars are thin.
    EXPECT_NEAR(run.Rows.back().EulerCharacteristic, expected.Rows.back().EulerCharacteristic, 24);
    EXPECT_NEAR(run.Rows.back().Components, expected.Rows.back().Components, 12);
    EXPECT_NEAR(run.Enclosed, expected.Enclosed, 10);
    ExpectEdgesWithin(run.Surface, 0.999 * run.Surface.Delta, 2.501 * run.Surface.Delta);
  }
}

TEST(Passes, AreIndependentOfThreadTiming)
{
  const auto hashOfRun = [](Executor& executor)
  {
    Monitor monitor;
    const SweptRun run(InBlocksOf(0.), executor, monitor);
    std::uint64_t hash = HashOf(run.Surface.Triangles, HashOf(run.Surface.Points));
    EditCounts edits;
    for (const HistoryRow& row : run.Rows)
    {
      edits.Merges += row.Merges;
      edits.Cuts += row.Cuts;
      edits.Splits += row.Splits;
      hash = HashOf(std::vector<double>{ row.KineticEnergy, row.MeanEdgeLength, row.TimeStep,
                      double(row.Vertices), double(row.Collapses), double(row.Flips) },
        hash);
    }
    EXPECT_GT(std::min({ edits.Merges, edits.Cuts, edits.Splits / 30 }), 3);
    EXPECT_GT(run.Enclosed, 0);
    return hash;
  };
  Executor thread;
  const std::uint64_t expected = hashOfRun(thread);
  for (const int threads : { 2, 3, 7 })
  {
    DelayedThreads executor(threads, static_cast<unsigned>(threads) * 77, 60, 16);
    EXPECT_EQ(hashOfRun(executor), expected) << threads << " threads";
  }
}

namespace
{
/** A large irregular surface, with passes of the central block. */
struct IrregularSurface
{
  TestVolume Volume = MakeVolume(110,
    [](double x, double y, double z)
    {
      return 0.5 + std::sin(0.7 * x) * std::sin(0.6 * y) + std::cos(0.65 * z) -
        0.02 * std::abs(x - 55.);
    });
  SurfaceOptions Options = IsoHalf();
  Executor Thread;
  Field TheField{ this->Volume.Image, this->Options, this->Thread };
  Dynamics Motion{ this->TheField, this->Options, this->Thread };
  SurfaceState State;
  std::unique_ptr<SurfaceBlocks> Blocks;

  IrregularSurface()
  {
    // Nearby spheres, for merges, cuts and splits.
    ForVoxels({ 5, 5, 5 },
      [this](int i, int j, int k)
      {
        const Point centre = { 19. + 15.5 * i, 19. + 15.5 * j, 19. + 15.5 * k };
        this->State.Mesh.Append(DividedIcosahedron(centre, 6.8, 1.7));
      });
    this->State.Sizing = SizingField(1.f);
    this->State.Margin = this->TheField.Margin();
    this->State.Reset(Vector(-2, -2, -2), Vector(112, 112, 112));
    std::vector<int> all(this->State.Mesh.Size());
    std::iota(all.begin(), all.end(), 0);
    this->State.UpdateShape(all, this->Thread);
    this->Blocks = std::make_unique<SurfaceBlocks>(this->State,
      SurfaceBlocks::FrameOf({ 110., 110., 110. }, SurfaceBlocks::SideInDelta), this->Thread);
  }

  /** Run a pass of the central block. @return numbers of edits */
  EditCounts RunCentralPass(int iterations, Box& written)
  {
    BlockPass pass = this->Blocks->Open(this->Blocks->BlockAt(Vector(55, 55, 55)));
    written = pass.Written;
    {
      SurfaceIteration iteration(this->State, pass, &this->TheField, true);
      for (int i = 0; i < iterations; ++i)
      {
        iteration.Run(this->Motion, SurfaceIteration::Mode::Evolve);
      }
    }
    const EditCounts counts = pass.Context.Counts;
    this->Blocks->Close(std::move(pass));
    return counts;
  }
};
}

TEST(Passes, WriteOnlyInBlock)
{
  IrregularSurface before;
  IrregularSurface after;
  Box written;
  const EditCounts counts = after.RunCentralPass(25, written);
  EXPECT_GT(counts.Merges, 10);
  EXPECT_GT(counts.Splits, 100);
  EXPECT_GT(counts.Collapses + counts.Cuts, 100);
  int beyond = 0, moved = 0;
  for (int v = 0; v < before.State.Mesh.Size(); ++v)
  {
    if (!before.State.Mesh.IsAlive(v))
    {
      continue;
    }
    const Vector& p = before.State.Mesh.Position[v];
    if (written.Contains(p))
    {
      moved +=
        !after.State.Mesh.IsAlive(v) || SquaredDistance(p, after.State.Mesh.Position[v]) > 0.f;
      continue;
    }
    ++beyond;
    ASSERT_TRUE(after.State.Mesh.IsAlive(v));
    ASSERT_EQ(SquaredDistance(p, after.State.Mesh.Position[v]), 0.f);
    const Ring& ring = before.State.Mesh.Rings[v];
    const Ring& now = after.State.Mesh.Rings[v];
    ASSERT_EQ(now.Count, ring.Count);
    ASSERT_TRUE(std::equal(ring.Item, ring.Item + ring.Count, now.Item));
    ASSERT_EQ(after.State.Active[v], before.State.Active[v]);
    ASSERT_EQ(after.State.RemeshFlags[v], before.State.RemeshFlags[v]);
    ASSERT_EQ(after.State.MotionSinceTest[v], before.State.MotionSinceTest[v]);
    ASSERT_EQ(after.State.Marks[v], 0);
  }
  EXPECT_GT(beyond, 5000);
  EXPECT_GT(moved, 1000);
  EXPECT_EQ(DescribeBrokenInvariant(after.State.Mesh), "");
  EXPECT_EQ(CountSelfIntersections(after.State.Mesh.ToIndexed()), 0);
}

TEST(Passes, DependOnlyOnHalo)
{
  IrregularSurface one;
  IrregularSurface other;
  const Box read =
    one.Blocks->BoxOf(one.Blocks->BlockAt(Vector(55, 55, 55))).Grown(SurfaceBlocks::HaloInDelta);
  int changed = 0;
  for (int v = 0; v < other.State.Mesh.Size(); ++v)
  {
    if (other.State.Mesh.IsAlive(v) && !read.Contains(other.State.Mesh.Position[v]))
    {
      other.State.MoveTo(v, other.State.Mesh.Position[v] * 1.01f);
      other.State.Normal[v] = NormalCone();
      other.State.Marks[v] = 255;
      ++changed;
    }
  }
  EXPECT_GT(changed, 1000);
  Box written;
  one.RunCentralPass(25, written);
  other.RunCentralPass(25, written);
  ASSERT_EQ(one.State.Mesh.Size(), other.State.Mesh.Size());
  for (int v = 0; v < one.State.Mesh.Size(); ++v)
  {
    ASSERT_EQ(one.State.Mesh.IsAlive(v), other.State.Mesh.IsAlive(v));
    if (one.State.Mesh.IsAlive(v) && read.Contains(one.State.Mesh.Position[v]))
    {
      ASSERT_EQ(SquaredDistance(one.State.Mesh.Position[v], other.State.Mesh.Position[v]), 0.f);
      ASSERT_EQ(one.State.Active[v], other.State.Active[v]);
    }
  }
}
