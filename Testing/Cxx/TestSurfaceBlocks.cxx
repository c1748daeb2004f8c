// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceEditor.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
Executor Thread;

/** Return a row of balls along x with distance 10: one in each block of side 10. */
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
  const auto blocks = [side](float length) { return static_cast<int>(std::ceil(length / side)); };
  return { bounds.Low, { side, side, side },
    { blocks(extent.X), blocks(extent.Y), blocks(extent.Z) } };
}

/** Return the alive vertices of a block. */
std::vector<int> VerticesOf(SurfaceBlocks& blocks, const SurfaceMesh& mesh, int block)
{
  BlockPass pass = blocks.Open(block);
  std::vector<int> vertices;
  for (int v = pass.First; v < pass.End(); ++v)
  {
    if (mesh.IsAlive(v))
    {
      vertices.push_back(v);
    }
  }
  blocks.Close(std::move(pass));
  return vertices;
}

/** Return the block of the vertex at a position; -1: none, -2: several. */
int BlockWith(SurfaceBlocks& blocks, const SurfaceMesh& mesh, const Vector& position)
{
  int found = -1;
  for (const int block : blocks.Schedule().Order())
  {
    for (const int v : VerticesOf(blocks, mesh, block))
    {
      if (SquaredDistance(mesh.Position[v], position) == 0.f)
      {
        found = found == -1 ? block : -2;
      }
    }
  }
  return found;
}
}

TEST(SurfaceBlocks, ReassignStrayVerticesBetweenSweeps)
{
  LiveSurface state(Balls(4));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const Vector near(
    blocks.BoxOf(0).High.X + 0.4f * SurfaceBlocks::MovingInDelta * state.Sizing.Smallest(), 1, 0);
  const Vector far(21, 0, 0);
  const std::vector<int> vertices = VerticesOf(blocks, state.Mesh, 0);
  state.MoveTo(vertices[0], near);
  VerticesOf(blocks, state.Mesh, 0);
  blocks.Prepare(Thread);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, near), 0)
    << "a vertex near its block causes no renumbering";
  state.MoveTo(vertices[1], far);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, far), 0) << "a vertex keeps its block within a sweep";
  blocks.Prepare(Thread);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, far), 2);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, near), 1);
  const Vector beyond(-40, 0, 0);
  state.MoveTo(VerticesOf(blocks, state.Mesh, 2).front(), beyond);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, beyond), 2);
  blocks.Prepare(Thread);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, beyond), 0) << "the outermost block is unbounded";
}

TEST(SurfaceBlocks, ReorderVertexProperties)
{
  LiveSurface state(Balls(3));
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    state.FieldValue[v] = state.Mesh.Position[v].Z;
    state.Velocity[v] = state.Mesh.Position[v];
    state.Active[v] = state.Mesh.Position[v].Z > 0.f;
  }
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 5.f), Thread);
  state.Velocity[0] = Vector(9, 9, 9);
  int alive = 0;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    EXPECT_TRUE(state.Mesh.IsAlive(v) || !state.Active[v]);
    if (state.Mesh.IsAlive(v) && v > 0)
    {
      ++alive;
      EXPECT_EQ(state.FieldValue[v], state.Mesh.Position[v].Z);
      EXPECT_EQ(SquaredDistance(state.Velocity[v], state.Mesh.Position[v]), 0.f);
      EXPECT_EQ(state.Active[v], state.Mesh.Position[v].Z > 0.f);
      bool isThere = false;
      state.Grid.Visit(state.Mesh.Position[v], 0.f, [&](int w) { isThere = isThere || w == v; });
      EXPECT_TRUE(isThere);
    }
  }
  EXPECT_EQ(alive, state.Mesh.NumberOfVertices() - 1);
}

TEST(SurfaceBlocks, OwnNewVerticesOfTheirPasses)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const int before = state.Mesh.NumberOfVertices();
  BlockPass pass = blocks.Open(1);
  pass.Context.Region = pass.Context.Region.Grown(1000.f);
  SurfaceEditor editor(state, &pass.Context);
  const int end = pass.End();
  const int v = pass.First;
  const Edit split = editor.Split(v, state.Mesh.Rings[v].Item[0]);
  ASSERT_TRUE(split.IsDone);
  EXPECT_EQ(split.Vertex, end);
  EXPECT_EQ(pass.End(), end + 1);
  // Slots of removed vertices are not reused before the renumbering.
  const int old = pass.First + (end - pass.First) / 2;
  const int beside = state.Mesh.Rings[old].Item[0];
  ASSERT_TRUE(editor.Collapse(old, beside, EditTolerance::Loose).IsDone);
  const int kept = state.Mesh.IsAlive(old) ? old : beside;
  EXPECT_EQ(editor.Split(kept, state.Mesh.Rings[kept].Item[0]).Vertex, end + 1);
  const Vector position = state.Mesh.Position[split.Vertex];
  blocks.Close(std::move(pass));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before + 1);
  EXPECT_EQ(BlockWith(blocks, state.Mesh, position), 1);
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

TEST(SurfaceBlocks, GetMoreSlotsAfterUse)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const auto takeAll = [&]
  {
    BlockPass pass = blocks.Open(1);
    const int size = pass.Context.Slots.End - pass.Context.Slots.Next;
    pass.Context.Slots.Next = pass.Context.Slots.End; // As if edits had used all slots.
    blocks.Close(std::move(pass));
    return size;
  };
  const int first = takeAll();
  EXPECT_GT(first, 0);
  BlockPass pass = blocks.Open(1);
  SurfaceEditor editor(state, &pass.Context);
  EXPECT_FALSE(pass.Context.Slots.Has(1));
  EXPECT_FALSE(editor.Split(pass.First, state.Mesh.Rings[pass.First].Item[0])) << "no free slot";
  blocks.Close(std::move(pass));
  blocks.Prepare(Thread);
  EXPECT_GT(takeAll(), 0);
  blocks.Prepare(Thread);
  EXPECT_GT(takeAll(), first) << "used slots increase the number of slots";
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

TEST(SurfaceBlocks, RejectEditsOutsideRegion)
{
  LiveSurface state(Balls(3));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  BlockPass pass = blocks.Open(1);
  SurfaceEditor editor(state, &pass.Context);
  const float end = blocks.BoxOf(1).High.X;
  int beyond = 0, within = 0;
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
  blocks.Close(std::move(pass));
}

TEST(SurfaceBlocks, RejectIntersectingSurfaces)
{
  // A surface without normals is tested in all directions.
  SurfaceState state;
  state.Sizing = SizingField(1.f);
  state.Mesh = Balls(2);
  state.Reset(Vector(-20, -20, -20), Vector(40, 40, 40));
  SurfaceBlocks blocks(state, FrameAbout(state.Mesh, 10.f), Thread);
  const int before = state.Mesh.NumberOfVertices();
  // One ball intersects the second ball, the other intersects none.
  SurfaceMesh added;
  added.Append(DividedIcosahedron({ 14., 0., 0. }, 3., 1.5));
  const int through = added.NumberOfVertices();
  added.Append(DividedIcosahedron({ 0., 15., 0. }, 4., 1.5));
  const int beside = added.NumberOfVertices() - through;
  EXPECT_FALSE(blocks.Append(added.ToIndexed(), false, Thread));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before);
  EXPECT_EQ(state.EulerCharacteristic, 4);
  EXPECT_FALSE(blocks.Append(added.ToIndexed(), true, Thread));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before + beside);
  EXPECT_EQ(state.EulerCharacteristic, 6);
}

TEST(SurfaceIteration, MovesOnlyVerticesNearBlock)
{
  LiveSurface s(Balls(3));
  SurfaceBlocks blocks(s, FrameAbout(s.Mesh, 10.f), Thread);
  const auto movedIn = [&](BlockPass& pass, const Vector& position)
  {
    const std::vector<int> active = SurfaceIteration(s, pass, nullptr, true).ActiveVertices();
    return std::any_of(active.begin(), active.end(),
      [&](int v) { return SquaredDistance(s.Mesh.Position[v], position) == 0.f; });
  };
  BlockPass pass = blocks.Open(1);
  const float end = blocks.BoxOf(1).High.X;
  const Vector near(end + 0.9f * SurfaceBlocks::MovingInDelta, 0, 0);
  const Vector far(end + 1.1f * SurfaceBlocks::MovingInDelta, 0, 0);
  s.MoveTo(pass.First, near);
  s.MoveTo(pass.First + 1, far);
  EXPECT_TRUE(movedIn(pass, near));
  EXPECT_FALSE(movedIn(pass, far));
  blocks.Close(std::move(pass));
  blocks.Prepare(Thread);
  pass = blocks.Open(2);
  EXPECT_TRUE(movedIn(pass, far)) << "the adjacent block moves it";
  blocks.Close(std::move(pass));
}
