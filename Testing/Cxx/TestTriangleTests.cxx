// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Intersection and distance of two triangles, intersection of new faces with a mesh.
#include "Core/Mesh/TriangleDistance.h"
#include "Core/Surface/NewFaces.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
MeshTriangle Named(int name, const VectorD& a, const VectorD& b, const VectorD& c)
{
  return { { name, name + 1, name + 2 }, { a, b, c } };
}

const MeshTriangle Corner = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
}

TEST(TriangleTests, DetectsCrossingInEitherOrder)
{
  // An edge of the second pierces the first. No edge of the first intersects the second.
  const MeshTriangle across = Named(3, { 1, 1, -1 }, { 1, 1, 1 }, { 2, 1, 1 });
  EXPECT_TRUE(TrianglesIntersect(Corner, across, 1e-9));
  EXPECT_TRUE(TrianglesIntersect(across, Corner, 1e-9));
  EXPECT_FALSE(TrianglesIntersect(Corner, Named(3, { 3, 3, -1 }, { 3, 3, 1 }, { 4, 3, 1 }), 1e-9));
  EXPECT_FALSE(TrianglesIntersect(Corner, Named(3, { 1, 1, 1 }, { 1, 1, 2 }, { 2, 1, 1 }), 1e-9));
}

TEST(TriangleTests, IntersectWithinTolerance)
{
  const MeshTriangle g = Named(3, { 1, 1, 0.001 }, { 1, 1, 1 }, { 2, 1, 1 });
  EXPECT_FALSE(TrianglesIntersect(Corner, g, 1e-4));
  EXPECT_TRUE(TrianglesIntersect(Corner, g, 1e-2));
}

TEST(TriangleTests, NeedleDoesNotIntersectBeyondTips)
{
  // The other triangle shares a tip and lies beyond it. Offset by the tolerance, the long edges of
  // the needle would meet a hundred lengths beyond the tip.
  const float thin = 1e-6f;
  const MeshTriangle needle = { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, thin, 0 } } };
  const MeshTriangle behind = { { 0, 3, 4 },
    { { 0, 0, 0 }, { -0.25, -0.5, -0.25 }, { -0.25, 0.5, 0.25 } } };
  EXPECT_FALSE(TrianglesIntersect(needle, behind, 1e-4));
  EXPECT_FALSE(TrianglesIntersect(behind, needle, 1e-4));
  const MeshTriangle across = { { 0, 3, 4 },
    { { 0, 0, 0 }, { 0.25, -0.5, -0.25 }, { 0.25, 0.5, 0.25 } } };
  EXPECT_TRUE(TrianglesIntersect(needle, across, 1e-4));
  EXPECT_FALSE(
    TrianglesIntersect({ { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0, 0 } } }, behind, 1e-4));
}

TEST(TriangleTests, DetectsCoplanarContainment)
{
  // For any orientation of the plane: the planar test drops one coordinate.
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto turned = [axis](double a, double b)
    { return axis == 0 ? VectorD(0, a, b) : (axis == 1 ? VectorD(b, 0, a) : VectorD(a, b, 0)); };
    const MeshTriangle large = Named(0, turned(-9, -9), turned(9, -9), turned(0, 9));
    const MeshTriangle small = Named(3, turned(0, 0), turned(1, 0), turned(0, 1));
    EXPECT_TRUE(TrianglesIntersect(large, small, 1e-9)) << axis;
    EXPECT_TRUE(TrianglesIntersect(small, large, 1e-9)) << axis;
    const MeshTriangle beside = Named(3, turned(8, 8), turned(9, 8), turned(8, 9));
    EXPECT_FALSE(TrianglesIntersect(large, beside, 1e-9)) << axis;
  }
}

TEST(TriangleTests, DetectsFoldForAnyOrientation)
{
  const VectorD a(0, 0, 0);
  const VectorD b(4, 0, 0);
  for (const double side : { 1., -1. })
  {
    const VectorD c(1, 3 * side, 0.001);
    EXPECT_EQ(TrianglesIntersect(Corner, { { 1, 0, 3 }, { b, a, c } }, 1e-9), side > 0.);
    EXPECT_EQ(TrianglesIntersect(Corner, { { 0, 1, 3 }, { a, b, c } }, 1e-9), side > 0.);
    EXPECT_EQ(TrianglesIntersect(Corner, { { 3, 0, 1 }, { c, a, b } }, 1e-9), side > 0.);
  }
}

TEST(TriangleTests, SharedCornersAndEdgesDoNotIntersect)
{
  // A common edge: flat and folded.
  EXPECT_FALSE(
    TrianglesIntersect(Corner, { { 1, 3, 2 }, { { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesIntersect(Corner, { { 1, 3, 2 }, { { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 } } }, 1e-9));
  // A common corner: disjoint and crossing.
  EXPECT_FALSE(
    TrianglesIntersect(Corner, { { 0, 3, 4 }, { { 0, 0, 0 }, { -4, 0, 0 }, { 0, -4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesIntersect(Corner, { { 0, 3, 4 }, { { 0, 0, 0 }, { 2, 2, 1 }, { 1, 1, -1 } } }, 1e-9));
}

TEST(NewFacesIntersect, IgnoresRemovedFaces)
{
  const LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6));
  const Vector p = state.Mesh.Position[9];
  // A triangle that crosses the surface at vertex 9.
  const VectorD n(Normalized(p));
  const VectorD side(0.1, 0.2, 0.1);
  const std::vector<MeshTriangle> through = { Named(
    1000, VectorD(p) * 1.1 + side, VectorD(p) * 0.9 + side, VectorD(p) * 0.9 + side * 2.) };
  EXPECT_TRUE(NewFacesIntersect(state, through, RemovedFaces()));
  EXPECT_FALSE(NewFacesIntersect(state, through, { { 9 }, 1, false }));
}

TEST(NewFacesIntersect, TestsNewFacesAgainstEachOther)
{
  const LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6));
  const MeshTriangle flat = Named(1000, { 10, 0, 0 }, { 12, 0, 0 }, { 10, 2, 0 });
  const MeshTriangle across = Named(2000, { 10.5, 0.5, -1 }, { 10.5, 0.5, 1 }, { 11, 0.5, 1 });
  const MeshTriangle beside = Named(2000, { 10.5, 0.5, 1 }, { 10.5, 0.5, 2 }, { 11, 0.5, 2 });
  EXPECT_TRUE(NewFacesIntersect(state, { flat, across }, RemovedFaces()));
  EXPECT_FALSE(NewFacesIntersect(state, { flat, beside }, RemovedFaces()));
}

namespace
{
constexpr int Steps = 40;

/** Return points of a triangle, including its edges and corners. */
std::vector<VectorD> SamplesOf(const MeshTriangle& t)
{
  std::vector<VectorD> samples;
  for (int i = 0; i <= Steps; ++i)
  {
    for (int j = 0; i + j <= Steps; ++j)
    {
      samples.push_back(t.Corner[0] + (t.Corner[1] - t.Corner[0]) * (1. * i / Steps) +
        (t.Corner[2] - t.Corner[0]) * (1. * j / Steps));
    }
  }
  return samples;
}

double GapBetween(const MeshTriangle& f, const MeshTriangle& g)
{
  return std::sqrt(SquaredGapBetween(f, g));
}
}

TEST(TriangleDistance, GapMatchesSampledMinimum)
{
  std::mt19937 random(2);
  const auto pointFrom = [&random](double x)
  {
    const auto next = [&random] { return static_cast<double>(random() % 1000) / 1000.; };
    return VectorD(x + next(), next(), next());
  };
  for (int n = 0; n < 60; ++n)
  {
    const MeshTriangle f = Named(0, pointFrom(0.), pointFrom(0.), pointFrom(0.));
    const MeshTriangle g = Named(3, pointFrom(1.1), pointFrom(1.1), pointFrom(1.1));
    const std::vector<VectorD> ofG = SamplesOf(g);
    double nearest = 9.;
    for (const VectorD& a : SamplesOf(f))
    {
      for (const VectorD& b : ofG)
      {
        nearest = std::min(nearest, Length(a - b));
      }
    }
    EXPECT_LE(GapBetween(f, g), nearest + 1e-12);
    EXPECT_GT(GapBetween(f, g), nearest - 3.6 / Steps);
    EXPECT_NEAR(GapBetween(f, g), GapBetween(g, f), 1e-12);
  }
}

TEST(TriangleDistance, GapIgnoresSharedVertices)
{
  const VectorD a(0, 0, 0);
  const VectorD b(1, 0, 0);
  const MeshTriangle f = Named(0, a, b, { 0, 1, 0 });
  // A common edge: unfolded and folded.
  EXPECT_NEAR(GapBetween(f, { { 1, 0, 3 }, { b, a, VectorD(0, -1, 0) } }), std::sqrt(.5), 1e-12);
  EXPECT_NEAR(GapBetween(f, { { 1, 0, 3 }, { b, a, VectorD(.2, .2, .1) } }), .1, 1e-12);
  // A common corner: opposite and nearly coplanar.
  EXPECT_NEAR(GapBetween(f, { { 0, 3, 4 }, { a, VectorD(-1, 0, 0), VectorD(0, -1, 0) } }),
    std::sqrt(.5), 1e-12);
  EXPECT_NEAR(
    GapBetween(f, { { 0, 3, 4 }, { a, VectorD(.3, .3, .05), VectorD(0, 0, 1) } }), .05, 1e-12);
  // An edge above another one.
  EXPECT_NEAR(
    GapBetween(f, { { 2, 3, 4 }, { VectorD(0, 1, 0), VectorD(.5, -.5, .02), VectorD(0, .5, 2) } }),
    .04 / 3., 1e-4);
}
