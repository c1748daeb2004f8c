// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Selection of edges for split, collapse and flip. Lengths in delta.
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Surface/Remesher.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
/** Return a sphere with edge lengths from 1.1 to 1.25. */
IndexedSurface FineSphere()
{
  return DividedIcosahedron({ 0, 0, 0 }, 10.2, 1.3);
}

/** Split an edge at u and flip it, which leaves a vertex of valence 3. */
int SetIntoAFace(SurfaceState& s, int u)
{
  const int v = s.Mesh.Rings[u].Item[1];
  const int m = EdgeSplit{ u, v }.Apply(s.Mesh, (s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f);
  EdgeFlip::Of(s.Mesh, m, u).Apply(s.Mesh);
  const Ring& ring = s.Mesh.Rings[m];
  s.Mesh.Position[m] = (s.Mesh.Position[ring.Item[0]] + s.Mesh.Position[ring.Item[1]] +
                         s.Mesh.Position[ring.Item[2]]) *
    (1.f / 3);
  s.AddVertex(m, u);
  return m;
}
}

TEST(Remesher, SplitAvoidsNeedles)
{
  // A tetrahedron with one edge that is too long and a vertex near its midpoint or an end.
  for (const auto& [x, height, isGraded, splits] :
    std::vector<std::tuple<double, double, bool, int>>{ { 0, 0.01, false, 0 },
      { 0, 0.04, false, 1 }, { 0, 0.04, true, 0 }, { 0, 0.06, true, 1 }, { -1.28, 0.01, true, 0 },
      { -1.28, 0.01, false, 1 }, { -1.28, 0.03, true, 1 }, { -1.1, 0.01, true, 1 } })
  {
    IndexedSurface cap;
    cap.Points = { { -1.3, 0, 0 }, { 1.3, 0, 0 }, { x, 0, height }, { 0, -1, -1 } };
    cap.Triangles = { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 2, 3 }, { 2, 1, 3 } };
    LiveSurface bench(cap);
    std::vector<int> all = bench.All();
    const LargeVector<float> sizes(8, 1.f);
    bench.Sizing = isGraded ? bench.Sizing.Graded(sizes, 1, 0.2f) : bench.Sizing;
    Remesher(bench, nullptr, true).Split(all);
    EXPECT_EQ(bench.Counts.Splits, splits);
    EXPECT_EQ((bench.RemeshFlags[0] & HasLongEdge) != 0, splits == 0) << "the edge is tested again";
  }
}

TEST(Remesher, SplitsNoShortEdgeToMakeRoom)
{
  // A long edge of a half circle. The rings of both opposite vertices are full, one is near an end.
  IndexedSurface cone = DoubleCone(Ring::Capacity);
  for (int i = 0; i < Ring::Capacity; ++i)
  {
    const double a = 3.14159265358979 * (1 + i / (Ring::Capacity - 1.));
    cone.Points[2 + i] = { 1.3 * std::cos(a), 1.3 * std::sin(a), 0 };
  }
  cone.Points[0] = { -0.95, -0.01, 0.2 };
  cone.Points[1] = { 0, -0.5, -1 };
  LiveSurface bench(cone);
  const LargeVector<float> sizes(99, 1.f);
  bench.Sizing = bench.Sizing.Graded(sizes, 1, 0.2f);
  std::vector<int> all = bench.All();
  Remesher(bench, nullptr, true).Split(all);
  EXPECT_FALSE(bench.Mesh.AreNeighbours(2, 1 + Ring::Capacity));
  EXPECT_TRUE(bench.Mesh.AreNeighbours(0, 2)) << "the short edge";
}

TEST(Remesher, RemovesVertexOfValenceThree)
{
  LiveSurface bench(FineSphere());
  const LargeVector<Vector> before = bench.Mesh.Position;
  const int m = SetIntoAFace(bench, 40);
  ASSERT_EQ(bench.Mesh.Rings[m].Count, 3);
  bench.UpdateShape();
  Remesher(bench, nullptr, true).Collapse({ m });
  EXPECT_FALSE(bench.Mesh.IsAlive(m));
  EXPECT_EQ(bench.Mesh.NumberOfVertices(), static_cast<int>(before.size()));
  for (std::size_t v = 0; v < before.size(); ++v)
  {
    EXPECT_EQ(Length(bench.Mesh.Position[v] - before[v]), 0);
  }
}

TEST(Remesher, CutsAlongThreeCycles)
{
  LiveSurface bench(MakeTorus({ 0, 0, 0 }, 5, 0.5, 18, 3));
  Remesher(bench, nullptr, true).Collapse(bench.All());
  EXPECT_GT(bench.Counts.Cuts, 0);
  EXPECT_GE(bench.EulerCharacteristic, 2) << "the torus is cut";
  EXPECT_TRUE(bench.IsSound());
}

TEST(Remesher, FlipsOnlyNonDelaunayEdges)
{
  LiveSurface bench(FineSphere());
  bench.RemeshFlags.Fill(IsNotDelaunay);
  Remesher(bench, nullptr, true).Flip(bench.All());
  EXPECT_EQ(bench.Counts.Flips, 0) << "all edges are Delaunay";
  const int u = 40;
  const int v = bench.Mesh.Rings[u].Item[0];
  EdgeFlip::Of(bench.Mesh, u, v).Apply(bench.Mesh);
  ASSERT_FALSE(bench.Mesh.AreNeighbours(u, v));
  bench.UpdateShape();
  Remesher(bench, nullptr, true).Flip(bench.All());
  EXPECT_EQ(bench.Counts.Flips, 1);
  EXPECT_TRUE(bench.Mesh.AreNeighbours(u, v));
  EXPECT_TRUE(bench.IsSound());
}

TEST(Remesher, SmoothsStuckVerticesAfterRollbacks)
{
  for (const int rollBacks : { 0, 2, 5, 6 })
  {
    LiveSurface bench(DividedIcosahedron({ 0, 0, 0 }, 10, 2.1));
    ExpectEdgesWithin(bench.Mesh.ToIndexed(), 1.3, 9); // nothing to collapse
    const Vector before = bench.Mesh.Position[40];
    bench.RollbackCount[40] = static_cast<std::uint8_t>(rollBacks);
    bench.Velocity[40] = Vector(1, 0, 0);
    Remesher(bench, nullptr, true).Unstick(bench.All());
    const double distance = Length(bench.Mesh.Position[40] - before);
    const bool isStuck = rollBacks == 6;
    EXPECT_TRUE(isStuck ? distance > 0.01 : distance == 0) << distance;
    EXPECT_EQ(bench.RollbackCount[40], isStuck ? 0 : rollBacks);
    EXPECT_EQ(Length(bench.Velocity[40]), isStuck ? 0 : 1);
    EXPECT_EQ(bench.Mesh.NumberOfVertices(), static_cast<int>(bench.Active.Size()));
  }
}

TEST(Remesher, EditsActivateChangedVertices)
{
  LiveSurface bench(FineSphere());
  const int w = bench.Mesh.Rings[40].Item[0];
  const Vector p = bench.Mesh.Position[40];
  bench.MoveTo(w, p + (bench.Mesh.Position[w] - p) * 0.4f);
  bench.UpdateShape();
  bench.Active.Fill(0);
  Remesher(bench, nullptr, true).Collapse(bench.All());
  const SurfaceState& s = bench;
  const int kept = s.Mesh.IsAlive(40) ? 40 : w;
  EXPECT_TRUE(s.Active[kept]);
  for (int v : bench.All())
  {
    EXPECT_EQ(s.Active[v] != 0, v == kept || s.Mesh.AreNeighbours(v, kept));
  }
}
