// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The judge itself, on surfaces whose verdict is known: nothing else can be trusted before this.
// Here topology and intersections; lengths, shapes and volumes in TestSurfaceJudgeMeasures.cxx.

#include "SimpleSurfaces.h"
#include "SurfaceJudge.h"
#include "TestPrelude.h"

using namespace volumic::support;

//------------------------------------------------------------------------------
TEST(JudgeTopology, AcceptsATetrahedron)
{
  const TopologyVerdict verdict = JudgeTopology(Tetrahedron(2.0, { 1e4, 0.0, 0.0 }));
  EXPECT_TRUE(verdict.Closed && verdict.Manifold && verdict.Oriented && verdict.Outward);
  EXPECT_EQ(verdict.EulerCharacteristic, 2);
  EXPECT_EQ(verdict.Genus, 0);
  ASSERT_EQ(verdict.Components.size(), 1u);
  EXPECT_NEAR(verdict.Volume, 8.0 / 6.0, 1e-12);
  EXPECT_NEAR(verdict.Area, 6.0 + 2.0 * std::sqrt(3.0), 1e-12);
}

TEST(JudgeTopology, FindsTheGenusOfEveryComponent)
{
  TriangleSurface surface = Tetrahedron(1.0, { 100.0, 0.0, 0.0 });
  Append(surface, Torus(24, 12, 5.0, 2.0));
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_TRUE(verdict.Outward);
  ASSERT_EQ(verdict.Components.size(), 2u);
  EXPECT_EQ(verdict.Components[0].Genus, 1); // the torus is larger
  EXPECT_EQ(verdict.Components[0].Vertices, 288u);
  EXPECT_EQ(verdict.Components[1].Genus, 0);
  EXPECT_EQ(verdict.Genus, 1);
  EXPECT_EQ(verdict.EulerCharacteristic, 2);
}

TEST(JudgeTopology, FindsAHole)
{
  TriangleSurface surface = Torus(12, 8, 5.0, 2.0);
  surface.Triangles.pop_back();
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_EQ(verdict.OpenEdges, 3u);
  EXPECT_FALSE(verdict.Closed);
  EXPECT_TRUE(verdict.Manifold && verdict.Oriented);
  EXPECT_EQ(verdict.Genus, -1);
}

TEST(JudgeTopology, FindsATriangleTheWrongWayRound)
{
  TriangleSurface surface = Torus(12, 8, 5.0, 2.0);
  std::swap(surface.Triangles[5][0], surface.Triangles[5][1]);
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_EQ(verdict.MisorientedEdges, 3u);
  EXPECT_FALSE(verdict.Oriented);
  EXPECT_TRUE(verdict.Closed && verdict.Manifold);
  EXPECT_FALSE(verdict.Outward);
}

TEST(JudgeTopology, FindsAnEdgeOfThreeTriangles)
{
  TriangleSurface surface = Tetrahedron();
  surface.Points.push_back({ -1.0, -1.0, -1.0 });
  surface.Triangles.push_back({ 0, 1, 4 });
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_EQ(verdict.NonManifoldEdges, 1u);
  EXPECT_EQ(verdict.OpenEdges, 2u);
  EXPECT_FALSE(verdict.Manifold);
}

TEST(JudgeTopology, FindsAVertexOfTwoFans)
{
  TriangleSurface surface = Tetrahedron();
  TriangleSurface other = Tetrahedron(-1.0);
  other = Reversed(other);
  Append(surface, other);
  for (auto& t : surface.Triangles)
  {
    for (int& v : t)
    {
      v = v == 4 ? 0 : v; // both apexes become one
    }
  }
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_EQ(verdict.NonManifoldVertices, 1u);
  EXPECT_EQ(verdict.UnusedPoints, 1u);
  EXPECT_FALSE(verdict.Manifold);
  EXPECT_TRUE(verdict.Closed);
  EXPECT_EQ(verdict.Components.size(), 2u);
}

TEST(JudgeTopology, FindsARepeatedCorner)
{
  TriangleSurface surface = Tetrahedron();
  surface.Triangles.push_back({ 1, 1, 2 });
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_EQ(verdict.DegenerateTriangles, 1u);
  EXPECT_FALSE(verdict.Manifold);
}

TEST(JudgeTopology, FindsASurfaceInsideOut)
{
  const TopologyVerdict verdict = JudgeTopology(Reversed(Tetrahedron()));
  EXPECT_TRUE(verdict.Closed && verdict.Manifold && verdict.Oriented);
  EXPECT_FALSE(verdict.Outward);
  EXPECT_NEAR(verdict.Volume, -1.0 / 6.0, 1e-12);
}

TEST(JudgeTopology, WantsCavitiesTheOtherWayRound)
{
  TriangleSurface outer = Tetrahedron(100.0, { -10.0, -10.0, -10.0 });
  TriangleSurface hollow = outer;
  Append(hollow, Reversed(Tetrahedron(20.0)));
  TopologyVerdict verdict = JudgeTopology(hollow);
  EXPECT_TRUE(verdict.Outward);
  EXPECT_EQ(verdict.Components[1].Depth, 1);
  EXPECT_LT(verdict.Components[1].Volume, 0.0);

  Append(hollow, Tetrahedron(1.0, { 3.0, 3.0, 3.0 })); // a thing inside the cavity
  verdict = JudgeTopology(hollow);
  EXPECT_TRUE(verdict.Outward);
  EXPECT_EQ(verdict.Components[2].Depth, 2);

  Append(outer, Tetrahedron(20.0));
  EXPECT_FALSE(JudgeTopology(outer).Outward);
}

TEST(JudgeTopology, DoesNotTakeNeighboursForNested)
{
  // In the box of the ring, but in its hole.
  TriangleSurface surface = Torus(48, 24, 5.0, 1.0);
  Append(surface, Tetrahedron(0.5));
  const TopologyVerdict verdict = JudgeTopology(surface);
  EXPECT_TRUE(verdict.Outward);
  EXPECT_EQ(verdict.Components[1].Depth, 0);
}

TEST(JudgeTopology, AcceptsNothingWhereThereIsNothing)
{
  const TopologyVerdict verdict = JudgeTopology(TriangleSurface());
  EXPECT_FALSE(verdict.Closed || verdict.Manifold || verdict.Oriented || verdict.Outward);
}

//------------------------------------------------------------------------------
TEST(JudgeIntersections, PassesASoundSurface)
{
  TriangleSurface surface = Torus(48, 24, 5.0, 2.0);
  Append(surface, Tetrahedron(0.5));
  const IntersectionVerdict verdict = JudgeIntersections(surface);
  EXPECT_EQ(verdict.Pairs, 0u);
  EXPECT_EQ(verdict.FlatTriangles, 0u);
}

TEST(JudgeIntersections, CountsPairs)
{
  // The tip of one tetrahedron pierces the slanted face of the other.
  TriangleSurface surface = Tetrahedron(3.0);
  TriangleSurface needle;
  needle.Points = { { 0.5, 0.5, 0.5 }, { 5.0, 5.0, 5.0 }, { 5.1, 5.0, 5.0 }, { 5.0, 5.1, 5.0 } };
  needle.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
  Append(surface, needle);
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 3u);
}

TEST(JudgeIntersections, CountsTheTouchOfAVertex)
{
  TriangleSurface surface = Tetrahedron(2.0);
  Append(surface, Tetrahedron(-2.0)); // touches the corner at the origin, without sharing it
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 9u);
}

TEST(JudgeIntersections, FindsAFoldAtASharedEdge)
{
  TriangleSurface surface;
  surface.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 0 } };
  surface.Triangles = { { 0, 1, 2 }, { 1, 0, 3 } };
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 1u);
  surface.Points[3] = { 0.5, -0.5, 0 };
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 0u);
}

TEST(JudgeIntersections, CountsFlatTrianglesApart)
{
  TriangleSurface surface = Tetrahedron();
  TriangleSurface flat;
  flat.Points = { { 9, 0, 0 }, { 10, 0, 0 }, { 11, 0, 0 } };
  flat.Triangles = { { 0, 1, 2 } };
  Append(surface, flat);
  const IntersectionVerdict verdict = JudgeIntersections(surface);
  EXPECT_EQ(verdict.Pairs, 0u);
  EXPECT_EQ(verdict.FlatTriangles, 1u);
}

TEST(JudgeIntersections, JudgesNonManifoldSurfacesAlike)
{
  TriangleSurface surface = Torus(40, 20, 5.0, 2.0);
  TriangleSurface moved = surface;
  for (auto& p : moved.Points)
  {
    p = { p[0] + 1.013, p[1] + 0.517, p[2] + 0.211 };
  }
  Append(surface, moved);
  const std::size_t pairs = JudgeIntersections(surface).Pairs;
  EXPECT_GT(pairs, 100u);

  // Three triangles at an edge far away, which alone make no intersection.
  TriangleSurface book;
  book.Points = { { 50, 0, 0 }, { 51, 0, 0 }, { 50, 1, 0 }, { 50, -1, 0 }, { 50, 0, 1 } };
  book.Triangles = { { 0, 1, 2 }, { 0, 1, 3 }, { 0, 1, 4 } };
  EXPECT_EQ(JudgeIntersections(book).Pairs, 0u);
  Append(surface, book);
  EXPECT_EQ(JudgeIntersections(surface).Pairs, pairs);

  // In that case, too, folds and touches at shared vertices count.
  TriangleSurface folded = book;
  folded.Points[3] = { 50.2, 0.5, 0.0 }; // falls onto the first page
  EXPECT_EQ(JudgeIntersections(folded).Pairs, 1u);
  folded = book;
  folded.Points.insert(folded.Points.end(), { { 51, -2, 0.5 }, { 51, 2, 0.5 } });
  folded.Triangles.push_back({ 0, 5, 6 }); // cuts the third page, with which it shares a vertex
  EXPECT_EQ(JudgeIntersections(folded).Pairs, 1u);
  folded = book;
  folded.Triangles.push_back({ 1, 2, 0 });
  EXPECT_EQ(JudgeIntersections(folded).Pairs, 1u); // the same page twice
}

//------------------------------------------------------------------------------
TEST(JudgeInvalid, SurfacesAreRefused)
{
  TriangleSurface surface = Tetrahedron();
  surface.Triangles[1][2] = 4;
  EXPECT_THROW(JudgeTopology(surface), std::invalid_argument);
  EXPECT_THROW(JudgeIntersections(surface), std::invalid_argument);
  EXPECT_THROW(JudgeLengths(surface, 1.0), std::invalid_argument);
  EXPECT_THROW(JudgeShapes(surface), std::invalid_argument);
  surface = Tetrahedron();
  surface.Points[0][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(JudgeTopology(surface), std::invalid_argument);
  EXPECT_THROW(JudgeIsoDistance(Tetrahedron(), JudgedVolume()), std::invalid_argument);
  EXPECT_THROW(JudgeReach(Tetrahedron(), JudgedVolume()), std::invalid_argument);
}
