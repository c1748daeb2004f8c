// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
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
  Executor threads(3);
  // Some are not there; the last third comes to a grid that is not empty.
  const auto isThere = [](int v) { return v % 5 != 2; };
  const int third = mesh.Size() / 3;
  for (int v = third - 1; v >= 0; --v)
  {
    if (isThere(v))
    {
      all.Insert(v, mesh.Position[v]);
    }
  }
  all.InsertAll(mesh.Position, static_cast<std::size_t>(third), isThere, threads);
  // From the last to the first, each by way of somewhere else.
  VertexGrid one;
  one.Reset(Vector(0, 0, 0), Vector(40, 40, 40), 1.3f);
  for (int v = mesh.Size() - 1; v >= 0; --v)
  {
    if (isThere(v))
    {
      one.Insert(v, mesh.Position[v] * 0.9f);
    }
  }
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (isThere(v))
    {
      one.Move(v, mesh.Position[v]);
    }
  }
  EXPECT_GT(visited(one).size(), 1000u);
  EXPECT_EQ(visited(one), visited(all));
}

