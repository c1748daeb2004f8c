// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
#define EXPECT_SOUND(mesh, chi)                 \
  EXPECT_EQ(DescribeBrokenInvariant(mesh), ""); \
  EXPECT_EQ((mesh).CountEulerCharacteristic(), chi)
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
  EXPECT_SOUND(one, 2);
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
  EXPECT_SOUND(mesh, 2);
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

TEST(SurfaceMesh, SupportsFreeSlots)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int size = mesh.Size();
  std::vector<int> order(static_cast<std::size_t>(size) + 2, NoVertex);
  std::iota(order.begin(), order.begin() + 4, 0);
  std::iota(order.begin() + 6, order.end(), 4);
  const Vector fifth = mesh.Position[4];
  mesh.Reorder(order);
  EXPECT_EQ(mesh.Size(), size + 2);
  EXPECT_EQ(mesh.NumberOfVertices(), size);
  EXPECT_FALSE(mesh.IsAlive(4) || mesh.IsAlive(5));
  EXPECT_EQ(SquaredDistance(mesh.Position[6], fifth), 0.f);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  VertexSlots slots = { 4, 6 };
  EXPECT_EQ(EdgeSplit({ 0, mesh.Rings[0].Item[0] }).Apply(mesh, Vector(0, 0, 7), &slots), 4);
  EXPECT_TRUE(slots.Has(1));
  EXPECT_FALSE(slots.Has(2));
  mesh.Count(slots);
  EXPECT_EQ(mesh.NumberOfVertices(), size + 1);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  mesh.Reorder(SpaceFillingOrder(mesh, 1.));
  EXPECT_EQ(mesh.Size(), size + 1);
  EXPECT_EQ(mesh.NumberOfVertices(), size + 1);
}

TEST(SurfaceMeshInvalid, RejectsInvalidSurfaces)
{
  const IndexedSurface once = Icosahedron({ 0, 0, 0 }, 1);
  IndexedSurface open = once;
  open.Triangles.pop_back();
  IndexedSurface twisted = once;
  std::swap(twisted.Triangles[3][0], twisted.Triangles[3][1]);
  IndexedSurface twice = once; // Every fan closes twice.
  twice.Triangles.insert(twice.Triangles.end(), once.Triangles.begin(), once.Triangles.end());
  // Two icosahedra with one point in common.
  IndexedSurface pinched = once;
  const IndexedSurface other = Icosahedron({ 5, 0, 0 }, 1);
  pinched.Points.insert(pinched.Points.end(), other.Points.begin() + 1, other.Points.end());
  for (const Triangle& t : other.Triangles)
  {
    const auto moved = [](int v) { return v == 0 ? 9 : v + 11; };
    pinched.Triangles.push_back({ moved(t[0]), moved(t[1]), moved(t[2]) });
  }
  const std::map<std::string, IndexedSurface> wrong = { { "open", open }, { "twisted", twisted },
    { "twice", twice }, { "pinched", pinched } };
  for (const auto& [name, surface] : wrong)
  {
    SurfaceMesh mesh;
    EXPECT_THROW(mesh.Append(surface), std::invalid_argument) << name;
  }
}

namespace
{
/** Return a double cone: tips 0 and 1 with `sides` neighbours each, then the others in order. */
SurfaceMesh DoubleCone(int sides)
{
  SurfaceMesh mesh;
  mesh.Append(MakeDoubleCone({ 0, 0, 0 }, 3, 2, sides));
  return mesh;
}
}

TEST(EdgeFlip, IsIllegalForFullRing)
{
  // A flip of an edge of the belt would join the tips. Test both directions.
  for (const int u : { 4, 5 })
  {
    EXPECT_TRUE(EdgeFlip::Of(DoubleCone(14), u, 9 - u).IsLegal(DoubleCone(14)));
    EXPECT_FALSE(EdgeFlip::Of(DoubleCone(15), u, 9 - u).IsLegal(DoubleCone(15)));
  }
  // One full ring suffices.
  SurfaceMesh mesh = DoubleCone(15);
  mesh.Rings[1].Count = 14;
  EXPECT_FALSE(EdgeFlip::Of(mesh, 4, 5).IsLegal(mesh));
  EXPECT_FALSE(EdgeFlip::Of(mesh, 5, 4).IsLegal(mesh));
}

TEST(EdgeSplit, IsIllegalForFullRing)
{
  EXPECT_TRUE((EdgeSplit{ 4, 5 }).IsLegal(DoubleCone(14)));
  SurfaceMesh mesh = DoubleCone(15);
  mesh.Rings[1].Count = 14;
  EXPECT_FALSE((EdgeSplit{ 4, 5 }).IsLegal(mesh));
  EXPECT_FALSE((EdgeSplit{ 5, 4 }).IsLegal(mesh));
}

TEST(EdgeCollapse, IsBlockedByAThirdCommonNeighbour)
{
  // Two tetrahedra with a common triangle: 0, 1, 2 are pairwise neighbours but not a face.
  SurfaceMesh mesh;
  mesh.Append({ { { 1, 0, 0 }, { -1, 1, 0 }, { -1, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } },
    { { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 }, { 1, 0, 4 }, { 2, 1, 4 }, { 0, 2, 4 } } });
  const EdgeCollapse collapse{ 0, 1 };
  EXPECT_EQ(collapse.ThirdCommonNeighbour(mesh), 2);
  EXPECT_FALSE(collapse.IsLegal(mesh));
}
