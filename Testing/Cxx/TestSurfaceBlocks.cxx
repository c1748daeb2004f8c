// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceEditor.h"
#include "LiveSurface.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
SequentialExecutor Thread;

/** A row of balls along x, 10 apart: one in each block of side 10. */
SurfaceMesh Balls(int n)
{
  SurfaceMesh mesh;
  for (int i = 0; i < n; ++i)
  {
    mesh.Append(DividedIcosahedron({ 10. * i, 0, 0 }, 4., 1.5));
  }
  return mesh;
}

SurfaceBlocks::Frame FrameAbout(const SurfaceMesh& mesh, float side)
{
  const Box bounds = BoundsOf(mesh, Thread);
  const Vector extent = bounds.High - bounds.Low;
  SurfaceBlocks::Frame frame;
  frame.Low = bounds.Low;
  frame.Side = { side, side, side };
  frame.Size = { static_cast<int>(std::ceil(extent.X / side)),
    static_cast<int>(std::ceil(extent.Y / side)), static_cast<int>(std::ceil(extent.Z / side)) };
  return frame;
}

std::map<int, int> Visited(SurfaceBlocks& blocks)
{
  std::map<int, int> visits;
  for (const int block : blocks.Schedule().Order())
  {
    BlockVisit visit = blocks.Open(block);
    for (const int v : visit.Vertices)
    {
      ++visits[v];
    }
    blocks.Close(std::move(visit));
  }
  return visits;
}

/** The block that has a vertex; -1: none, -2: several. */
int BlockWith(SurfaceBlocks& blocks, int v)
{
  int found = -1;
  for (const int block : blocks.Schedule().Order())
  {
    BlockVisit visit = blocks.Open(block);
    for (const int w : visit.Vertices)
    {
      if (w == v)
      {
        found = found == -1 ? block : -2;
      }
    }
    blocks.Close(std::move(visit));
  }
  return found;
}
}

TEST(SurfaceBlocks, HaveEachVertexOnce)
{
  LiveSurface state(MakeSphere({ 0, 0, 0 }, 20, 1.5));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 9.f), Thread);
  EXPECT_EQ(blocks.Schedule().Order().size(), 125u);
  const std::map<int, int> visits = Visited(blocks);
  EXPECT_EQ(static_cast<int>(visits.size()), state.Mesh.NumberOfVertices());
  for (const auto& [v, count] : visits)
  {
    EXPECT_EQ(count, 1) << v;
  }
}

TEST(SurfaceBlocks, ComeBeforeTheirNeighboursOfOddPlace)
{
  LiveSurface state(Balls(6));
  SurfaceBlocks row(state, FrameAbout(state.Mesh, 10.f), Thread);
  EXPECT_EQ(row.Schedule().Order(), (std::vector<int>{ 0, 2, 1, 4, 3, 5 }));
  LiveSurface cube(MakeSphere({ 0, 0, 0 }, 20, 1.5));
  SurfaceBlocks blocks(cube, FrameAbout(cube.Mesh, 9.f), Thread);
  std::vector<int> turn(125);
  for (int i = 0; i < 125; ++i)
  {
    turn[blocks.Schedule().Order()[i]] = i;
  }
  const auto colour = [](int block)
  { return (block % 5 & 1) | (block / 5 % 5 & 1) << 1 | (block / 25 & 1) << 2; };
  for (int a = 0; a < 125; ++a)
  {
    for (int b = 0; b < 125; ++b)
    {
      const bool touch = std::abs(a % 5 - b % 5) <= 1 &&
        std::abs(a / 5 % 5 - b / 5 % 5) <= 1 && std::abs(a / 25 - b / 25) <= 1;
      if (touch && colour(a) < colour(b))
      {
        EXPECT_LT(turn[a], turn[b]) << a << " " << b;
      }
    }
  }
}

TEST(SurfaceBlocks, HandOverWhatLeavesThem)
{
  LiveSurface state(Balls(4));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  BlockVisit first = blocks.Open(0);
  state.MoveTo(3, Vector(21, 0, 0));
  blocks.Close(std::move(first));
  EXPECT_EQ(BlockWith(blocks, 3), 2);
  BlockVisit last = blocks.Open(2);
  state.MoveTo(3, Vector(-40, 0, 0));
  blocks.Close(std::move(last));
  EXPECT_EQ(BlockWith(blocks, 3), 0) << "what is beyond the first is the first's";
}

TEST(SurfaceBlocks, OwnTheNewVerticesOfTheirVisits)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  blocks.AddPlaces({ 0, 5, 0 }, OnThisThread());
  const int before = state.Mesh.NumberOfVertices();
  BlockVisit visit = blocks.Open(1);
  visit.Share.Region = visit.Share.Region.Grown(1000.f);
  SurfaceEditor editor(state, &visit.Share);
  const std::size_t given = visit.Vertices.size();
  const int v = visit.Vertices.front();
  const Edit split = editor.Split(v, state.Mesh.Rings[v].Item[0]);
  ASSERT_TRUE(split.IsDone);
  blocks.AddNew(visit, { v, split.Vertex, split.Vertex });
  EXPECT_EQ(visit.Vertices.size(), given + 1);
  EXPECT_EQ(visit.Vertices.back(), split.Vertex);
  // The place of an old one that is removed and used again is still in the list, once.
  const int old = visit.Vertices[given / 2];
  const int beside = state.Mesh.Rings[old].Item[0];
  ASSERT_TRUE(editor.Collapse(old, beside, EditTolerance::Loose).IsDone);
  const int gone = state.Mesh.IsAlive(old) ? beside : old;
  const int kept = gone == old ? beside : old;
  editor.EndPass();
  const Edit again = editor.Split(kept, state.Mesh.Rings[kept].Item[0]);
  ASSERT_TRUE(again.IsDone);
  ASSERT_EQ(again.Vertex, gone) << "taken again once the pass is over";
  blocks.AddNew(visit, { gone });
  EXPECT_EQ(std::count(visit.Vertices.begin(), visit.Vertices.end(), gone), 1);
  blocks.Close(std::move(visit));
  EXPECT_EQ(BlockWith(blocks, gone), 1);
  EXPECT_EQ(BlockWith(blocks, split.Vertex), 1);
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before + 1);
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

TEST(SurfaceBlocks, GetThePlacesOfTheirVerticesThatOthersHaveRemoved)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const int vertices = state.Mesh.NumberOfVertices();
  BlockVisit first = blocks.Open(0);
  const int v = first.Vertices.front();
  blocks.Close(std::move(first));
  BlockVisit other = blocks.Open(2);
  other.Share.Region = other.Share.Region.Grown(1000.f);
  SurfaceEditor editor(state, &other.Share);
  const int w = state.Mesh.Rings[v].Item[0];
  ASSERT_TRUE(editor.Collapse(v, w, EditTolerance::Loose).IsDone);
  const int place = state.Mesh.IsAlive(v) ? w : v;
  editor.EndPass();
  const int u = other.Vertices.front();
  EXPECT_FALSE(editor.Split(u, state.Mesh.Rings[u].Item[0])) << "not for one that is far away";
  blocks.Close(std::move(other));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
  EXPECT_EQ(BlockWith(blocks, place), -1);
  BlockVisit again = blocks.Open(0);
  EXPECT_EQ(again.Share.Places.Free, std::vector<int>{ place });
  SurfaceEditor own(state, &again.Share);
  again.Share.Region = again.Share.Region.Grown(1000.f);
  const int t = again.Vertices.front();
  EXPECT_EQ(own.Split(t, state.Mesh.Rings[t].Item[0]).Vertex, place);
  blocks.AddNew(again, { place });
  blocks.Close(std::move(again));
  EXPECT_EQ(BlockWith(blocks, place), 0);
  EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices);
}

TEST(SurfaceBlocks, KeepTheirPlacesForThemselves)
{
  LiveSurface state(Balls(3));
  const int vertices = state.Mesh.NumberOfVertices();
  const int size = state.Mesh.Size();
  {
    SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
    BlockVisit visit = blocks.Open(1);
    visit.Share.Region = visit.Share.Region.Grown(1000.f);
    SurfaceEditor editor(state, &visit.Share);
    const int v = visit.Vertices.front();
    EXPECT_FALSE(editor.Split(v, state.Mesh.Rings[v].Item[0])) << "it has no place for another";
    ASSERT_TRUE(editor.Collapse(v, state.Mesh.Rings[v].Item[0], EditTolerance::Loose).IsDone);
    blocks.Close(std::move(visit));
    EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
    EXPECT_EQ(state.Mesh.FreePlaces().size(), 0u) << "nobody else's";
    BlockVisit beside = blocks.Open(0);
    EXPECT_EQ(beside.Share.NumberOfPlaces(), 0);
    blocks.Close(std::move(beside));
    BlockVisit again = blocks.Open(1);
    EXPECT_EQ(again.Share.NumberOfPlaces(), 1);
    blocks.Close(std::move(again));
    blocks.AddPlaces({ 7, 0, 0 }, OnThisThread());
    EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
  }
  EXPECT_EQ(state.Mesh.FreePlaces().size(), 8u) << "given back";
  EXPECT_EQ(state.Mesh.Size(), size + 7);
  EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
}

TEST(SurfaceBlocks, AreEditedNoFurtherThanTheirRegion)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  blocks.AddPlaces({ 0, 50, 0 }, OnThisThread());
  BlockVisit visit = blocks.Open(1);
  SurfaceEditor editor(state, &visit.Share);
  const float end = blocks.BoxOf(1).High.X;
  int beyond = 0;
  int within = 0;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (!state.Mesh.IsAlive(v))
    {
      continue;
    }
    const float x = state.Mesh.Position[v].X;
    if (x > end + 1.05f * SurfaceBlocks::EditedInDelta)
    {
      const int w = state.Mesh.Rings[v].Item[0];
      EXPECT_FALSE(editor.Split(v, w).IsDone);
      EXPECT_FALSE(editor.Collapse(v, w, EditTolerance::Loose).IsDone);
      EXPECT_FALSE(editor.Flip(v, w, EditTolerance::Loose).IsDone);
      EXPECT_FALSE(editor.Move(v, state.Mesh.Position[v], EditTolerance::Loose).IsDone);
      ++beyond;
    }
    else if (x > end && x < end + 0.95f * SurfaceBlocks::EditedInDelta && within < 20)
    {
      EXPECT_TRUE(editor.Split(v, state.Mesh.Rings[v].Item[0]).IsDone);
      ++within;
    }
  }
  EXPECT_GT(beyond, 10);
  EXPECT_GT(within, 5);
  blocks.Close(std::move(visit));
}

TEST(SurfaceBlocks, KnowWhetherAnythingMoves)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  state.Active.Fill(0);
  EXPECT_FALSE(blocks.HasActive(1));
  BlockVisit visit = blocks.Open(1);
  state.Active[visit.Vertices.front()] = 1;
  blocks.Close(std::move(visit));
  EXPECT_TRUE(blocks.HasActive(1));
  EXPECT_FALSE(blocks.HasActive(0));
}

TEST(SurfaceBlocks, AreAsWideAsAskedAndShareTheRestAtBothEnds)
{
  SurfaceState state;
  for (const double extent : { 5., 47., 48.5, 71., 72.5, 100. })
  {
    const SurfaceBlocks::Frame frame = SurfaceBlocks::FrameOf({ extent, 5., 5. }, 24.);
    const SurfaceBlocks blocks(state, frame, Thread);
    const int last = blocks.NumberOfBlocks() - 1;
    EXPECT_EQ(last > 0, extent > 48.) << extent;
    for (int block = 1; block < last; ++block)
    {
      EXPECT_NEAR(blocks.BoxOf(block).High.X - blocks.BoxOf(block).Low.X, 24., 1e-4) << extent;
    }
    if (last > 0)
    {
      const double first = blocks.BoxOf(0).High.X;
      EXPECT_NEAR(first, extent - blocks.BoxOf(last).Low.X, 1e-4) << extent;
      EXPECT_TRUE(first >= 12. && first <= 24.) << extent << ": " << first;
    }
  }
}
