// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What a visit of a block may move, and how far.
#include "Core/Evolution/SurfaceIteration.h"
#include "EvolutionTestTools.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
/** Delta is 1. Three balls along x, one in each block of side 10. */
struct BallsInBlocks
{
  Executor Thread;
  SurfaceState State;

  BallsInBlocks()
  {
    for (int i = 0; i < 3; ++i)
    {
      this->State.Mesh.Append(DividedIcosahedron({ 5. + 10. * i, 0, 0 }, 4., 1.5));
    }
    this->State.Sizing = SizingField(1);
    this->State.Reset(Vector(-30, -30, -30), Vector(60, 30, 30));
    for (int v = 0; v < this->State.Mesh.Size(); ++v)
    {
      this->State.UpdateShape(v);
    }
  }

  static SurfaceBlocks::Frame Frame()
  {
    SurfaceBlocks::Frame frame;
    frame.Low = Vector(0, -20, -20);
    frame.Side = { 10, 40, 40 };
    frame.Size = { 3, 1, 1 };
    return frame;
  }
};

/** Balls in an image of one, in one block; delta is 1. */
struct BallsInOneBlock
{
  TestVolume Volume = BallVolume(40, 16.);
  SurfaceOptions Options = IsoHalf();
  Executor Thread;
  Field TheField{ this->Volume.Image, this->Options, this->Thread };
  Dynamics Motion{ this->TheField, this->Options, this->Thread };
  SurfaceState State;
  std::unique_ptr<SurfaceBlocks> Blocks;

  explicit BallsInOneBlock(const std::vector<IndexedSurface>& balls)
  {
    for (const IndexedSurface& ball : balls)
    {
      this->State.Mesh.Append(ball);
    }
    this->State.Sizing = SizingField(1);
    this->State.Margin = this->TheField.Margin();
    this->State.Reset(Vector(-2, -2, -2), Vector(42, 42, 42));
    for (int v = 0; v < this->State.Mesh.Size(); ++v)
    {
      this->State.UpdateShape(v);
    }
    this->Blocks = std::make_unique<SurfaceBlocks>(this->State,
      SurfaceBlocks::FrameOf({ 40., 40., 40. }, SurfaceBlocks::SideInDelta), this->Thread);
  }
};

/** Those that the visit of a block would move. */
std::vector<int> ActiveOnes(SurfaceState& state, SurfaceBlocks& blocks, int block)
{
  BlockVisit visit = blocks.Open(block);
  std::vector<int> active = SurfaceIteration(state, visit, nullptr, true).ActiveVertices();
  blocks.Close(std::move(visit));
  return active;
}

bool Has(const std::vector<int>& vertices, int v)
{
  return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
}
}

TEST(SurfaceIteration, MovesNothingFarFromTheBlock)
{
  BallsInBlocks balls;
  SurfaceState& s = balls.State;
  SurfaceBlocks blocks(s, BallsInBlocks::Frame(), balls.Thread);
  BlockVisit visit = blocks.Open(1);
  const int near = visit.First;
  const int far = visit.First + 1;
  s.MoveTo(near, Vector(20 + 0.9f * SurfaceBlocks::MovingInDelta, 0, 0));
  const Vector place(20 + 1.1f * SurfaceBlocks::MovingInDelta, 0, 0);
  s.MoveTo(far, place);
  std::vector<int> active = SurfaceIteration(s, visit, nullptr, true).ActiveVertices();
  EXPECT_TRUE(Has(active, near));
  EXPECT_FALSE(Has(active, far));
  blocks.Close(std::move(visit));
  blocks.Prepare(balls.Thread);
  visit = blocks.Open(2);
  active = SurfaceIteration(s, visit, nullptr, true).ActiveVertices();
  EXPECT_TRUE(std::any_of(active.begin(), active.end(),
    [&](int v) { return s.Mesh.Position[v].X == place.X && s.Mesh.Position[v].Y == 0.f; }))
    << "it is the neighbour's, which moves it";
  blocks.Close(std::move(visit));
}

TEST(SurfaceIteration, KeepsTheEndsOfHugeEdgesStill)
{
  BallsInBlocks balls;
  SurfaceState& s = balls.State;
  SurfaceBlocks blocks(s, BallsInBlocks::Frame(), balls.Thread);
  const int v = blocks.Open(1).First;
  const auto stretch = [&s, v](float factor)
  {
    const Vector centre(15, 0, 0);
    s.MoveTo(v, centre + Normalized(s.Mesh.Position[v] - centre) * factor);
    s.UpdateShape(v);
    const Ring& ring = s.Mesh.Rings[v];
    std::for_each(ring.Item, ring.Item + ring.Count, [&s](int w) { s.UpdateShape(w); });
  };
  stretch(6.3f); // Its edges are longer than 2.5 delta, but not than 1.4 times that.
  ASSERT_TRUE(s.RemeshFlags[v] & HasLongEdge);
  ASSERT_FALSE(s.RemeshFlags[v] & HasHugeEdge);
  EXPECT_TRUE(Has(ActiveOnes(s, blocks, 1), v));
  stretch(9.f);
  const std::vector<int> active = ActiveOnes(s, blocks, 1);
  EXPECT_TRUE(s.RemeshFlags[v] & HasHugeEdge);
  EXPECT_FALSE(Has(active, v));
  const Ring& ring = s.Mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    EXPECT_FALSE(Has(active, ring.Item[i])) << i;
  }
  EXPECT_EQ(static_cast<int>(active.size()), s.Mesh.NumberOfVertices() / 3 - 1 - ring.Count);
}

TEST(SurfaceIteration, MakesWhatCannotBeSplitNoLonger)
{
  // A ball that grows, where no vertex can be added.
  BallsInOneBlock balls({ DividedIcosahedron({ 20, 20, 20 }, 6., 1.5) });
  SurfaceState& s = balls.State;
  SurfaceBlocks& blocks = *balls.Blocks;
  BlockVisit visit = blocks.Open(0);
  visit.Share.Room.End = visit.Share.Room.Next;
  auto iteration = std::make_unique<SurfaceIteration>(s, visit, &balls.TheField, true);
  double longest = 0.;
  for (int i = 0; i < 40; ++i)
  {
    iteration->Run(balls.Motion, SurfaceIteration::Mode::Evolve);
    for (const double edge : EdgeLengths(s.Mesh.ToIndexed()))
    {
      longest = std::max(longest, edge);
      ASSERT_LE(edge, 2.5001) << "iteration " << i;
    }
  }
  iteration.reset();
  EXPECT_EQ(visit.Share.Counts.Splits, 0);
  EXPECT_GT(longest, 2.4) << "it has grown as far as it may";
  blocks.Close(std::move(visit));
  EXPECT_EQ(DescribeBrokenInvariant(s.Mesh), "");
}

TEST(SurfaceIteration, KnowsTheContactsThatAVisitBeforeHasFound)
{
  // Two balls that grow towards each other, in visits of an iteration. Nobody merges them.
  BallsInOneBlock balls(
    { DividedIcosahedron({ 15, 20, 20 }, 4., 1.5), DividedIcosahedron({ 25, 20, 20 }, 4., 1.5) });
  SurfaceState& s = balls.State;
  SurfaceBlocks& blocks = *balls.Blocks;
  std::vector<int> ofBall[2];
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      ofBall[s.Mesh.Position[v].X > 20.f].push_back(v);
    }
  }
  for (int i = 0; i < 12; ++i)
  {
    BlockVisit visit = blocks.Open(0);
    visit.Share.Room.End = visit.Share.Room.Next;
    SurfaceIteration(s, visit, &balls.TheField, false)
      .Run(balls.Motion, SurfaceIteration::Mode::Evolve);
    blocks.Close(std::move(visit));
  }
  float nearest = 100.f;
  for (const int v : ofBall[0])
  {
    for (const int w : ofBall[1])
    {
      nearest = std::min(nearest, SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]));
    }
  }
  EXPECT_LT(nearest, 2.2f) << "they have met";
  EXPECT_GT(nearest, .8f) << "and keep apart";
}
