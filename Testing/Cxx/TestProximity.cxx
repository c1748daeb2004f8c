// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "Executor.h"
#include "Proximity.h"
#include "TriangleTests.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <utility>

using namespace volumic;

namespace
{
SequentialExecutor Threads;

NamedTriangle Named(int name, const VectorD& a, const VectorD& b, const VectorD& c)
{
  return { { name, name + 1, name + 2 }, { a, b, c } };
}

SurfaceState MakeState(const IndexedSurface& surface, float delta)
{
  SurfaceState state;
  state.Mesh.Append(surface);
  state.Delta = delta;
  state.Reset(Vector(-20, -20, -20), Vector(40, 40, 40));
  return state;
}

std::vector<int> All(const SurfaceState& state)
{
  std::vector<int> all(state.Mesh.Size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void Add(IndexedSurface& to, const IndexedSurface& more)
{
  const int first = static_cast<int>(to.Points.size());
  to.Points.insert(to.Points.end(), more.Points.begin(), more.Points.end());
  for (const Triangle& t : more.Triangles)
  {
    to.Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  }
}
}

TEST(TriangleTests, FindsACrossing)
{
  const NamedTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  EXPECT_TRUE(
    TrianglesMeet(f, Named(3, { 1, 1, -1 }, { 1, 1, 1 }, { 2, 1, 1 }), 1e-9));
  EXPECT_FALSE(
    TrianglesMeet(f, Named(3, { 3, 3, -1 }, { 3, 3, 1 }, { 4, 3, 1 }), 1e-9));
  EXPECT_FALSE(
    TrianglesMeet(f, Named(3, { 1, 1, 1 }, { 1, 1, 2 }, { 2, 1, 1 }), 1e-9));
}

TEST(TriangleTests, CountsWhatComesNearerThanTheTolerance)
{
  const NamedTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  const NamedTriangle g = Named(3, { 1, 1, 0.001 }, { 1, 1, 1 }, { 2, 1, 1 });
  EXPECT_FALSE(TrianglesMeet(f, g, 1e-4));
  EXPECT_TRUE(TrianglesMeet(f, g, 1e-2));
}

TEST(TriangleTests, TellsCoplanarTrianglesApart)
{
  const NamedTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  EXPECT_TRUE(TrianglesMeet(f, Named(3, { 1, 1, 0 }, { 5, 1, 0 }, { 1, 5, 0 }), 1e-9));
  EXPECT_FALSE(TrianglesMeet(f, Named(3, { 5, 5, 0 }, { 9, 5, 0 }, { 5, 9, 0 }), 1e-9));
}

TEST(TriangleTests, DoesNotStretchANeedleBeyondItsTips)
{
  // The other triangle shares a tip and lies on its far side: set off by the tolerance, the lines
  // of the needle's long edges meet a hundred lengths further.
  const float thin = 1e-6f;
  const NamedTriangle needle = { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, thin, 0 } } };
  const NamedTriangle behind = { { 0, 3, 4 },
    { { 0, 0, 0 }, { -0.25, -0.5, -0.25 }, { -0.25, 0.5, 0.25 } } };
  EXPECT_FALSE(TrianglesMeet(needle, behind, 1e-4));
  EXPECT_FALSE(TrianglesMeet(behind, needle, 1e-4));
  const NamedTriangle across = { { 0, 3, 4 },
    { { 0, 0, 0 }, { 0.25, -0.5, -0.25 }, { 0.25, 0.5, 0.25 } } };
  EXPECT_TRUE(TrianglesMeet(needle, across, 1e-4));
  // All corners on one line.
  const NamedTriangle line = { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0, 0 } } };
  EXPECT_FALSE(TrianglesMeet(line, behind, 1e-4));
}

TEST(TriangleTests, AllowsSharedCornersAndEdgesOnly)
{
  const NamedTriangle f = { { 0, 1, 2 }, { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } } };
  // A common edge, flat and folded.
  EXPECT_FALSE(
    TrianglesMeet(f, { { 1, 3, 2 }, { { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesMeet(f, { { 1, 3, 2 }, { { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 } } }, 1e-9));
  // A common corner, beside and through.
  EXPECT_FALSE(
    TrianglesMeet(f, { { 0, 3, 4 }, { { 0, 0, 0 }, { -4, 0, 0 }, { 0, -4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesMeet(f, { { 0, 3, 4 }, { { 0, 0, 0 }, { 2, 2, 1 }, { 1, 1, -1 } } }, 1e-9));
}

TEST(VertexGrid, FindsAllWithinTheRadius)
{
  const SurfaceMesh mesh = MakeSphere({ 10, 10, 10 }, 6, 0.7);
  VertexGrid grid;
  grid.Reset(Vector(3, 3, 3), Vector(12, 18, 18), 1.3f); // Part of it lies beyond the grid.
  for (int v = 0; v < mesh.Size(); ++v)
  {
    grid.Insert(v, mesh.Position[v]);
  }
  grid.Remove(5);
  grid.Insert(5, mesh.Position[5]);
  for (int v = 0; v < mesh.Size(); v += 7)
  {
    std::set<int> found;
    grid.Visit(mesh.Position[v], 1.9f, [&](int w) { found.insert(w); });
    for (int w = 0; w < mesh.Size(); ++w)
    {
      if (SquaredDistance(mesh.Position[v], mesh.Position[w]) <= 1.9f * 1.9f)
      {
        EXPECT_TRUE(found.count(w)) << v << " " << w;
      }
    }
  }
}

TEST(Proximity, FindsNothingOnASmoothSphere)
{
  SurfaceState state = MakeState(DividedIcosahedron({ 5, 5, 5 }, 8, 1.6), 1);
  const std::vector<int> all = All(state);
  state.UpdateShape(all, Threads);
  Proximity proximity;
  proximity.Examine(state, all, Threads);
  EXPECT_TRUE(proximity.Pairs().empty());
  EXPECT_TRUE(proximity.Meetings().empty());
  EXPECT_EQ(std::count(state.Near.begin(), state.Near.end(), 1), 0);
}

TEST(Proximity, FindsThePairsOfTwoSpheresAsBruteForceDoes)
{
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
  const int second = static_cast<int>(surface.Points.size());
  Add(surface, DividedIcosahedron({ 12.8, 0, 0 }, 6, 1.6));
  SurfaceState state = MakeState(surface, 1);
  const std::vector<int> all = All(state);
  state.UpdateShape(all, Threads);
  Proximity proximity;
  proximity.Examine(state, all, Threads);
  std::set<std::pair<int, int>> expected;
  for (int v = 0; v < second; ++v)
  {
    for (int w = second; w < state.Mesh.Size(); ++w)
    {
      if (SquaredDistance(state.Mesh.Position[v], state.Mesh.Position[w]) <
        constraint::NearestOthers * constraint::NearestOthers)
      {
        expected.insert({ v, w });
        expected.insert({ w, v });
      }
    }
  }
  ASSERT_FALSE(expected.empty());
  std::set<std::pair<int, int>> found;
  for (const Proximity::ClosePair& pair : proximity.Pairs())
  {
    if (pair.Squared < constraint::NearestOthers * constraint::NearestOthers)
    {
      found.insert({ pair.V, pair.W });
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(Proximity, FindsWhetherTwoBodiesIntersectAtEveryDistance)
{
  for (double distance = 10.; distance < 13.; distance += 0.05)
  {
    IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
    Add(surface, DividedIcosahedron({ distance, 0.3, 0.2 }, 5.5, 1.7));
    SurfaceState state = MakeState(surface, 1);
    const std::vector<int> all = All(state);
    state.UpdateShape(all, Threads);
    Proximity proximity;
    proximity.Examine(state, all, Threads);
    const bool meets = CountSelfIntersections(surface, 1) > 0;
    // The tolerance may find a touch where there is none by less than it; never the other way.
    if (meets)
    {
      EXPECT_FALSE(proximity.Meetings().empty()) << "at distance " << distance;
    }
    else if (distance > 11.6)
    {
      EXPECT_TRUE(proximity.Meetings().empty()) << "at distance " << distance;
    }
  }
}

TEST(NewFacesMeet, SeesWhatIsThereButNotWhatGoes)
{
  SurfaceState state = MakeState(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6), 1);
  state.UpdateShape(All(state), Threads);
  const Vector p = state.Mesh.Position[9];
  // A triangle through the surface at vertex 9.
  const VectorD n(Normalized(p));
  const VectorD side(0.1, 0.2, 0.1);
  const std::vector<NamedTriangle> through = { Named(
    1000, VectorD(p) * 1.1 + side, VectorD(p) * 0.9 + side, VectorD(p) * 0.9 + side * 2.) };
  EXPECT_TRUE(NewFacesMeet(state, through, GoneFaces()));
  EXPECT_FALSE(NewFacesMeet(state, through, { { 9 }, 1, false }));
}
