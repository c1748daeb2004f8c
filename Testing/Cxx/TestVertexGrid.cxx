// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Mesh/VertexGrid.h"
#include "CoreTestTools.h"

using namespace volumic;

TEST(VertexGrid, FindsAllVerticesWithinRadius)
{
  const SurfaceMesh mesh = MakeSphere({ 10, 10, 10 }, 6, 0.7);
  VertexGrid grid;
  grid.Reset(Vector(3, 3, 3), Vector(12, 18, 18), 1.3f); // Part of the mesh is outside the grid.
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

TEST(VertexGrid, LimitsMemory)
{
  // 10^15 cells of the requested size.
  VertexGrid grid;
  grid.Reset(Vector(0, 0, 0), Vector(1e5f, 1e5f, 1e5f), 1.f);
  grid.Insert(0, Vector(9e4f, 1, 1));
  int found = 0;
  grid.Visit(Vector(9e4f, 1, 1), 1.f, [&](int) { ++found; });
  EXPECT_EQ(found, 1);
}

TEST(VertexGrid, VisitOrderIsIndependentOfInsertionOrder)
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
  // Some vertices are skipped. The last third is added to a nonempty grid.
  const auto isPresent = [](int v) { return v % 5 != 2; };
  const int third = mesh.Size() / 3;
  for (int v = third - 1; v >= 0; --v)
  {
    if (isPresent(v))
    {
      all.Insert(v, mesh.Position[v]);
    }
  }
  all.InsertAll(mesh.Position, static_cast<std::size_t>(third), isPresent, threads);
  // In reverse order, each at another position first.
  VertexGrid one;
  one.Reset(Vector(0, 0, 0), Vector(40, 40, 40), 1.3f);
  for (int v = mesh.Size() - 1; v >= 0; --v)
  {
    if (isPresent(v))
    {
      one.Insert(v, mesh.Position[v] * 0.9f);
    }
  }
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (isPresent(v))
    {
      one.Move(v, mesh.Position[v]);
    }
  }
  EXPECT_GT(visited(one).size(), 1000u);
  EXPECT_EQ(visited(one), visited(all));
}
