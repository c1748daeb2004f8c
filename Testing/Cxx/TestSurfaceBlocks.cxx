// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceEditor.h"
#include "MeshInvariants.h"
#include "RemeshTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

using namespace volumic;

namespace
{
SequentialExecutor Thread;

/** Delta is 1. */
struct LiveSurface : SurfaceState
{
  explicit LiveSurface(const SurfaceMesh& mesh)
  {
    this->Mesh = mesh;
    this->Sizing = SizingField(1);
    this->Reset(Vector(-30, -30, -30), Vector(70, 30, 30));
    std::vector<int> all(this->Mesh.Size());
    std::iota(all.begin(), all.end(), 0);
    this->UpdateShape(all, Thread);
  }
};

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
  for (const int block : blocks.Order())
  {
    for (const int v : blocks.Open(block))
    {
      ++visits[v];
    }
    blocks.Close();
  }
  return visits;
}

/** The block that has a vertex; -1: none, -2: several. */
int BlockWith(SurfaceBlocks& blocks, int v)
{
  int found = -1;
  for (const int block : blocks.Order())
  {
    const std::vector<int> vertices = blocks.Open(block);
    for (const int w : vertices)
    {
      if (w == v)
      {
        found = found == -1 ? block : -2;
      }
    }
    blocks.Close();
  }
  return found;
}
}

TEST(SurfaceBlocks, HaveEachVertexOnce)
{
  LiveSurface state(MakeSphere({ 0, 0, 0 }, 20, 1.5));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 9.f), Thread);
  EXPECT_EQ(blocks.Order().size(), 125u);
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
  EXPECT_EQ(row.Order(), (std::vector<int>{ 0, 2, 1, 4, 3, 5 }));
  LiveSurface cube(MakeSphere({ 0, 0, 0 }, 20, 1.5));
  SurfaceBlocks blocks(cube, FrameAbout(cube.Mesh, 9.f), Thread);
  std::vector<int> turn(125);
  for (int i = 0; i < 125; ++i)
  {
    turn[blocks.Order()[i]] = i;
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
  blocks.Open(0);
  state.MoveTo(3, Vector(21, 0, 0));
  blocks.Close();
  EXPECT_EQ(BlockWith(blocks, 3), 2);
  blocks.Open(2);
  state.MoveTo(3, Vector(-40, 0, 0));
  blocks.Close();
  EXPECT_EQ(BlockWith(blocks, 3), 0) << "what is beyond the first is the first's";
}

TEST(SurfaceBlocks, OwnTheNewVerticesOfTheirVisits)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  SurfaceEditor editor(state);
  const std::vector<int>& vertices = blocks.Open(1);
  const std::size_t before = vertices.size();
  const int v = vertices.front();
  const int size = state.Mesh.Size();
  const Edit split = editor.Split(v, state.Mesh.Rings[v].Item[0]);
  ASSERT_TRUE(split.IsDone);
  blocks.AddNew({ v, split.Vertex, split.Vertex });
  EXPECT_EQ(vertices.size(), before + 1);
  EXPECT_EQ(vertices.back(), split.Vertex);
  // The place of an old one that is removed and used again is still in the list, once.
  const int old = vertices[before / 2];
  const int beside = state.Mesh.Rings[old].Item[0];
  ASSERT_TRUE(editor.Collapse(old, beside, EditTolerance::Loose).IsDone);
  const int gone = state.Mesh.IsAlive(old) ? beside : old;
  const int kept = gone == old ? beside : old;
  const Edit again = editor.Split(kept, state.Mesh.Rings[kept].Item[0]);
  ASSERT_TRUE(again.IsDone);
  ASSERT_EQ(again.Vertex, gone);
  blocks.AddNew({ gone });
  EXPECT_EQ(std::count(vertices.begin(), vertices.end(), gone), 1);
  blocks.Close();
  EXPECT_EQ(BlockWith(blocks, gone), 1);
  EXPECT_EQ(state.Mesh.Size(), size + 1);
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

TEST(SurfaceBlocks, ForgetVerticesThatOthersHaveRemoved)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const std::vector<int> first = blocks.Open(0);
  blocks.Close();
  // During a visit of another one; its place is taken by that one's new vertex.
  blocks.Open(2);
  SurfaceEditor editor(state);
  const int v = first.front();
  ASSERT_TRUE(editor.Collapse(v, state.Mesh.Rings[v].Item[0], EditTolerance::Loose).IsDone);
  blocks.Close();
  const std::vector<int>& last = blocks.Open(2);
  const int place = [&]
  {
    for (const int w : first)
    {
      if (!state.Mesh.IsAlive(w))
      {
        return w;
      }
    }
    return -1;
  }();
  ASSERT_GE(place, 0);
  const int u = last.front();
  const Edit split = editor.Split(u, state.Mesh.Rings[u].Item[0]);
  ASSERT_EQ(split.Vertex, place);
  blocks.AddNew({ place });
  blocks.Close();
  EXPECT_EQ(BlockWith(blocks, place), 2);
}

TEST(SurfaceBlocks, KeepTheirPlacesForThemselves)
{
  LiveSurface state(Balls(3));
  const int vertices = state.Mesh.NumberOfVertices();
  int freed = 0;
  {
    SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
    SurfaceEditor editor(state);
    const int v = blocks.Open(1).front();
    ASSERT_TRUE(editor.Collapse(v, state.Mesh.Rings[v].Item[0], EditTolerance::Loose).IsDone);
    blocks.Close();
    EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
    EXPECT_EQ(state.Mesh.FreePlaces().size(), 0u) << "nobody else's";
    blocks.Open(0);
    EXPECT_EQ(state.Mesh.FreePlaces().size(), 0u);
    blocks.Close();
    blocks.Open(1);
    EXPECT_EQ(state.Mesh.FreePlaces().size(), 1u);
    freed = static_cast<int>(state.Mesh.FreePlaces().size());
    blocks.Close();
  }
  EXPECT_EQ(state.Mesh.FreePlaces().size(), static_cast<std::size_t>(freed)) << "given back";
  EXPECT_EQ(state.Mesh.NumberOfVertices(), vertices - 1);
}

TEST(SurfaceBlocks, KnowWhetherAnythingMoves)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  state.Active.Fill(0);
  EXPECT_FALSE(blocks.HasActive(1));
  state.Active[blocks.Open(1).front()] = 1;
  blocks.Close();
  EXPECT_TRUE(blocks.HasActive(1));
  EXPECT_FALSE(blocks.HasActive(0));
}
