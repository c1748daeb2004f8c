// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "CoreTestTools.h"

using namespace volumic;

TEST(SurfaceMesh, AppendIsIndependentOfThreads)
{
  // More triangles than one task processes, with those of a vertex far apart in the list.
  IndexedSurface surface = MakeSphere({ 0, 0, 0 }, 20, 0.5).ToIndexed();
  const std::size_t n = surface.Triangles.size();
  ASSERT_GT(n, 40000u);
  LargeVector<Triangle> mixed(n);
  constexpr std::size_t step = 7919; // A prime.
  ASSERT_NE(n % step, 0u);
  for (std::size_t i = 0; i < n; ++i)
  {
    mixed[i] = surface.Triangles[i * step % n];
  }
  surface.Triangles = mixed;
  SurfaceMesh one;
  one.Append(surface);
  EXPECT_EQ(DescribeBrokenInvariant(one), "");
  EXPECT_EQ(one.CountEulerCharacteristic(), 2);
  Executor threads(3);
  for (int run = 0; run < 5; ++run)
  {
    SurfaceMesh other;
    other.Append(surface, threads);
    ASSERT_EQ(one.Rings.size(), other.Rings.size());
    for (int v = 0; v < one.Size(); ++v)
    {
      const Ring& ring = one.Rings[v];
      ASSERT_TRUE(ring.Count == other.Rings[v].Count &&
        std::equal(ring.Item, ring.Item + ring.Count, other.Rings[v].Item))
        << v;
    }
  }
}

TEST(SurfaceMesh, ListingAndOrderAreIndependentOfThreads)
{
  // More vertices than one task processes, after many free slots.
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 10, 0.5);
  const int removed = mesh.Size();
  mesh.Append(DividedIcosahedron({ 3, -40, 2 }, 20, 0.4));
  for (int v = 0; v < removed; ++v)
  {
    mesh.RemoveVertex(v);
  }
  ASSERT_GT(mesh.NumberOfVertices(), 20000);
  Executor threads(3);
  const auto expectSame = [](const IndexedSurface& one, const IndexedSurface& other)
  {
    EXPECT_EQ(one.Points, other.Points);
    EXPECT_EQ(one.Triangles, other.Triangles);
  };
  expectSame(mesh.ToIndexed(threads), mesh.ToIndexed());
  EXPECT_EQ(mesh.NumberOfFaces(threads), mesh.NumberOfFaces());
  EXPECT_EQ(mesh.CountEulerCharacteristic(threads), 2);
  const std::vector<int> order = SpaceFillingOrder(mesh, 0.7, threads);
  EXPECT_EQ(order, SpaceFillingOrder(mesh, 0.7));
  SurfaceMesh other = mesh;
  mesh.Reorder(order, threads);
  other.Reorder(order);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  expectSame(mesh.ToIndexed(), other.ToIndexed());
}

TEST(SurfaceMesh, DetectsVerticesFarApart)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 6, 1.5);
  const int other = mesh.Append(Icosahedron({ 20, 0, 0 }, 3));
  for (const int from : { 0, 33, 100 })
  {
    // Distances to all others in edges, by breadth-first search.
    std::vector<int> edges(mesh.Size(), -1);
    std::vector<int> list(1, from);
    edges[from] = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      const Ring& ring = mesh.Rings[list[i]];
      for (int k = 0; k < ring.Count; ++k)
      {
        if (edges[ring.Item[k]] < 0)
        {
          edges[ring.Item[k]] = edges[list[i]] + 1;
          list.push_back(ring.Item[k]);
        }
      }
    }
    for (int v = 0; v < mesh.Size(); ++v)
    {
      if (v != from)
      {
        EXPECT_EQ(mesh.AreFarApart(from, v), v >= other || edges[v] >= 4) << edges[v];
      }
    }
  }
}
