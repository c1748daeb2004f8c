// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"
#include "Core/Mesh/VertexGrid.h"
#include "CoreTestTools.h"

using namespace volumic;

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

TEST(VertexGrid, FindsVerticesWhereTheyHaveMovedTo)
{
  VertexGrid grid;
  grid.Reset(Vector(0, 0, 0), Vector(20, 20, 20), 1.f);
  grid.Insert(0, Vector(3, 3, 3));
  grid.Insert(1, Vector(3, 3, 3));
  grid.Move(0, Vector(15, 4, 9));
  const auto within = [&grid](const Vector& place)
  {
    std::set<int> found;
    grid.Visit(place, 0.5f, [&](int w) { found.insert(w); });
    return found;
  };
  EXPECT_EQ(within(Vector(15, 4, 9)), std::set<int>{ 0 });
  EXPECT_EQ(within(Vector(3, 3, 3)), std::set<int>{ 1 });
}

TEST(VertexGrid, CostsNoMemoryWithoutLimit)
{
  // 10^15 cells, if they were as asked for.
  VertexGrid grid;
  grid.Reset(Vector(0, 0, 0), Vector(1e5f, 1e5f, 1e5f), 1.f);
  grid.Insert(0, Vector(9e4f, 1, 1));
  int found = 0;
  grid.Visit(Vector(9e4f, 1, 1), 1.f, [&](int) { ++found; });
  EXPECT_EQ(found, 1);
}

TEST(VertexGrid, TakesMemoryOnlyWhereVerticesAre)
{
  const SurfaceMesh mesh = MakeSphere({ 60, 60, 60 }, 50, 2);
  VertexGrid grid;
  grid.Reset(Vector(0, 0, 0), Vector(120, 120, 120), 0.5f); // 30^3 bricks.
  for (int v = 0; v < mesh.Size(); ++v)
  {
    grid.Insert(v, mesh.Position[v]);
  }
  // A sphere of 12.5 bricks' radius passes through some four bricks for each of its own area.
  EXPECT_GT(grid.NumberOfBricks(), 1000u);
  EXPECT_LT(grid.NumberOfBricks(), 6000u);
}

TEST(VertexGrid, IsTheSameWhenFilledAtOnce)
{
  const SurfaceMesh mesh = MakeSphere({ 20, 20, 20 }, 15, 0.7);
  const auto isThere = [](int v) { return v % 5 != 2; };
  VertexGrid one;
  one.Reset(Vector(3, 3, 3), Vector(40, 40, 33), 1.3f);
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (isThere(v))
    {
      one.Insert(v, mesh.Position[v]);
    }
  }
  VertexGrid other;
  other.Reset(Vector(3, 3, 3), Vector(40, 40, 33), 1.3f);
  StandardThreads threads(3);
  other.InsertAll(mesh.Position, 0, isThere, threads);
  // In the same order, too: what is found first may be decided by it.
  const auto visited = [](const VertexGrid& grid)
  {
    std::vector<int> found;
    grid.VisitBox(Vector(-9, -9, -9), Vector(50, 50, 50), [&](int w) { found.push_back(w); });
    return found;
  };
  EXPECT_GT(visited(one).size(), 1000u);
  EXPECT_EQ(visited(one), visited(other));
  // And where it is not empty: what comes behind those that are there.
  VertexGrid third;
  third.Reset(Vector(3, 3, 3), Vector(40, 40, 33), 1.3f);
  const int first = mesh.Size() / 3;
  for (int v = first - 1; v >= 0; --v)
  {
    if (isThere(v))
    {
      third.Insert(v, mesh.Position[v]);
    }
  }
  third.InsertAll(mesh.Position, static_cast<std::size_t>(first), isThere, threads);
  EXPECT_EQ(visited(one), visited(third));
}

TEST(VertexGrid, VisitsInTheSameOrderHoweverTheVerticesHaveCome)
{
  SurfaceMesh mesh = MakeSphere({ 20, 20, 20 }, 15, 0.7);
  const auto visited = [](const VertexGrid& grid)
  {
    std::vector<int> found;
    grid.VisitBox(Vector(-9, -9, -9), Vector(50, 50, 50), [&](int w) { found.push_back(w); });
    return found;
  };
  VertexGrid all;
  all.Reset(Vector(0, 0, 0), Vector(40, 40, 40), 1.3f);
  StandardThreads threads(3);
  all.InsertAll(mesh.Position, 0, [](int) { return true; }, threads);
  // From the last to the first, each by way of somewhere else.
  VertexGrid one;
  one.Reset(Vector(0, 0, 0), Vector(40, 40, 40), 1.3f);
  for (int v = mesh.Size() - 1; v >= 0; --v)
  {
    one.Insert(v, mesh.Position[v] * 0.9f);
  }
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const int w = (v * 7) % mesh.Size() == 0 ? v : mesh.Size() - 1 - v;
    one.Move(w, mesh.Position[w]);
  }
  for (int v = 0; v < mesh.Size(); ++v)
  {
    one.Move(v, mesh.Position[v]);
  }
  EXPECT_EQ(visited(one).size(), static_cast<std::size_t>(mesh.Size()));
  EXPECT_EQ(visited(one), visited(all));
}
