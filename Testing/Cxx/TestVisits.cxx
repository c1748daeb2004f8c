// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces that are worked on in visits of blocks: whole runs of small scenes.
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "EvolutionTestTools.h"
#include "ThreadTestTools.h"

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

/** Both levels of the bars in blocks of so many delta; 0: as usual. */
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
    evolution.StartEnclosing(scene.Coarse.Image, 1);
    if (evolution.Run() != StopReason::Cancelled && evolution.Divide(scene.Fine.Image, 0))
    {
      this->Enclosed = evolution.Missed().Enclosed + evolution.Missed().EnclosedCavities;
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

TEST(Passes, MakeTheSurfaceOfOneBlock)
{
  Executor thread;
  Monitor monitor;
  const SweptRun expected(InBlocksOf(1000.), thread, monitor);
  const double volume = EnclosedVolume(expected.Mesh(), thread);
  for (const double side : { 8., 12., 21. })
  {
    SCOPED_TRACE(side);
    const SweptRun run(InBlocksOf(side), thread, monitor);
    ExpectSound(run);
    EXPECT_NE(run.Surface.Points, expected.Surface.Points) << "not in several blocks";
    // From side to side they scatter by 2 %.
    EXPECT_NEAR(EnclosedVolume(run.Mesh(), thread), volume, 0.07 * volume);
    EXPECT_NEAR(run.Surface.Points.size(), expected.Surface.Points.size(),
      0.07 * static_cast<double>(expected.Surface.Points.size()));
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

TEST(Passes, MakeTheSameRunOnThreadsThatAreHeldUp)
{
  // It does all that there is to do: merges, cuts, splits, collapses, lost parts and cavities.
  const auto made = [](Executor& executor)
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
  const std::uint64_t alone = made(thread);
  for (const int threads : { 2, 3, 7 })
  {
    DelayedThreads executor(threads, static_cast<unsigned>(threads) * 77, 60, 16);
    EXPECT_EQ(made(executor), alone) << threads << " threads";
  }
}

namespace
{
/** A wild surface, many delta wide, that is visited in the middle of its blocks. */
struct Wilderness
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

  Wilderness()
  {
    // Spheres near each other, whose parts will merge, and are cut and split.
    for (const double x : { 19., 34., 50., 66., 81. })
    {
      for (const double y : { 19., 34., 50., 66., 81. })
      {
        for (const double z : { 19., 34., 50., 66., 81. })
        {
          this->State.Mesh.Append(DividedIcosahedron({ x, y, z }, 6.8, 1.7));
        }
      }
    }
    this->State.Sizing = SizingField(1.f);
    this->State.Margin = this->TheField.Margin();
    this->State.Reset(Vector(-2, -2, -2), Vector(112, 112, 112));
    std::vector<int> all(this->State.Mesh.Size());
    std::iota(all.begin(), all.end(), 0);
    this->State.UpdateShape(all, this->Thread);
    this->Blocks = std::make_unique<SurfaceBlocks>(this->State,
      SurfaceBlocks::FrameOf({ 110., 110., 110. }, SurfaceBlocks::SideInDelta), this->Thread);
  }

  /** Visits the block in the middle, for many iterations. @return what the edits were */
  EditCounts VisitMiddle(int iterations, Box& written)
  {
    BlockPass visit = this->Blocks->Open(this->Blocks->BlockAt(Vector(55, 55, 55)));
    written = visit.Written;
    {
      SurfaceIteration iteration(this->State, visit, &this->TheField, true);
      for (int i = 0; i < iterations; ++i)
      {
        iteration.Run(this->Motion, SurfaceIteration::Mode::Evolve);
      }
    }
    const EditCounts counts = visit.Context.Counts;
    this->Blocks->Close(std::move(visit));
    return counts;
  }
};
}

TEST(Passes, WriteNowhereElseHoweverManyIterationsTheyMake)
{
  Wilderness before;
  Wilderness after;
  Box written;
  const EditCounts counts = after.VisitMiddle(25, written);
  EXPECT_GT(counts.Merges, 10);
  EXPECT_GT(counts.Splits, 100);
  EXPECT_GT(counts.Collapses + counts.Cuts, 100);
  int beyond = 0;
  int moved = 0;
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

TEST(Passes, DependOnNothingFarAway)
{
  Wilderness one;
  Wilderness other;
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
  one.VisitMiddle(25, written);
  other.VisitMiddle(25, written);
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
