// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/VertexGrid.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
std::vector<RowCrossing> CrossingsOf(const IndexedSurface& surface, double y, double z)
{
  std::vector<RowCrossing> crossings;
  for (const Triangle& t : surface.Triangles)
  {
    const RowCrossing crossing =
      RowCrossing::Of(surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]], y, z);
    if (crossing.Winding != 0)
    {
      crossings.push_back(crossing);
    }
  }
  return crossings;
}
}

TEST(RowCrossing, CountsOnceAtEdgesAndCorners)
{
  const IndexedSurface surface = Octahedron({ 0, 0, 0 }, 4, 4, 4);
  // Through two corners, and along the planes of four edges each.
  for (const Point& p :
    std::vector<Point>{ { 0, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } })
  {
    const std::vector<RowCrossing> crossings = CrossingsOf(surface, p[1], p[2]);
    ASSERT_EQ(crossings.size(), 2u) << p[1] << " " << p[2];
    EXPECT_EQ(crossings[0].Winding + crossings[1].Winding, 0);
    EXPECT_NEAR(crossings[0].X + crossings[1].X, 0, 1e-12);
  }
  // Corners at the sides are missed, or entered and left at the same x.
  for (const Point& p : std::vector<Point>{ { 0, 4, 0 }, { 0, -4, 0 }, { 0, 0, 4 }, { 0, 0, -4 },
         { 0, 2, 2 }, { 0, -2, 2 }, { 0, 2, -2 }, { 0, -2, -2 } })
  {
    int sum = 0;
    for (const RowCrossing& crossing : CrossingsOf(surface, p[1], p[2]))
    {
      EXPECT_NEAR(crossing.X, 0, 1e-12);
      sum += crossing.Winding;
    }
    EXPECT_EQ(sum, 0) << p[1] << " " << p[2];
  }
}

TEST(RowGrid, FindsCrossingsOfAllRows)
{
  const RowGrid rows = { { 0, -2, 3 }, { 0, 9, 17 }, { 0., 0.65, 0.15 }, 0.7 };
  std::uint32_t random = 1;
  const auto next = [&random](double size)
  {
    random = random * 1664525u + 1013904223u;
    return size * (random >> 8) / (1 << 24) - 2.;
  };
  std::size_t all = 0;
  for (int n = 0; n < 300; ++n)
  {
    std::array<Point, 3> t;
    for (Point& p : t)
    {
      p = { next(9.), next(10.), next(16.) };
    }
    if (n % 3 == 0) // A sliver.
    {
      t[2] = { t[1][0] + 0.01, t[1][1] + 0.03, t[1][2] };
    }
    std::vector<RowGrid::Crossing> found;
    rows.AddCrossings(t, found);
    std::sort(found.begin(), found.end());
    auto crossing = found.begin();
    for (std::int64_t k = rows.First[2]; k < rows.End[2]; ++k)
    {
      for (std::int64_t j = rows.First[1]; j < rows.End[1]; ++j)
      {
        const RowCrossing requested =
          RowCrossing::Of(t[0], t[1], t[2], rows.Coordinate(1, j), rows.Coordinate(2, k));
        if (requested.Winding != 0)
        {
          ASSERT_NE(crossing, found.end());
          EXPECT_EQ(crossing->Row, rows.RowOf(j, k));
          EXPECT_EQ(crossing->Where.Winding, requested.Winding);
          EXPECT_EQ((crossing++)->Where.X, requested.X);
        }
      }
    }
    EXPECT_EQ(crossing, found.end());
    all += found.size();
  }
  EXPECT_GT(all, 1000u);
}

TEST(EnclosingComponents, ExcludeOwnComponent)
{
  std::vector<IndexedSurface> nested;
  for (const double size : { 4., 3., 2. })
  {
    nested.push_back(Octahedron({ 0, 0, 0 }, size, size, size));
  }
  const auto facesOf = [&nested](std::size_t begin, std::size_t end, const auto& visit)
  {
    for (std::size_t component = begin; component < end; ++component)
    {
      const IndexedSurface& surface = nested[component];
      for (const Triangle& t : surface.Triangles)
      {
        visit(surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]],
          static_cast<int>(component));
      }
    }
  };
  const std::vector<Point> points = { { 3.5, 0.1, 0.1 }, { 0, 0, 0 }, { -2.5, 0.1, 0 },
    { -9, 0.1, 0.1 }, { 0, 5, 0 } };
  using Lists = std::vector<std::vector<int>>;
  Executor threads(3);
  EXPECT_EQ(EnclosingComponents(points, {}, nested.size(), facesOf, threads),
    (Lists{ { 0 }, { 0, 1, 2 }, { 0, 1 }, {}, {} }));
  EXPECT_EQ(EnclosingComponents(points, { 0, 1, 1, -1, 2 }, nested.size(), facesOf, threads),
    (Lists{ {}, { 0, 2 }, { 0 }, {}, {} }));
}

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
