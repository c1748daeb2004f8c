// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Each check with a surface that only this check rejects.
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
std::string ErrorOf(const IndexedSurface& surface)
{
  return ErrorMessageOf([&] { CheckInitialSurface(surface); });
}

/** Return the error of a surface with invalid topology, which SurfaceMesh rejects, too. */
std::string ErrorOfTopology(const IndexedSurface& surface)
{
  EXPECT_THROW(MeshOf(surface), std::invalid_argument);
  return ErrorOf(surface);
}

std::string OutsideErrorOf(const IndexedSurface& surface)
{
  LevelImage image;
  image.Size = { 20, 20, 20 };
  image.Step = { 1, 1, 2 };
  return ErrorMessageOf([&] { CheckOverlapsImage(surface, image); });
}

IndexedSurface Ball(double x = 0, double radius = 2)
{
  return Icosahedron({ x, 0, 0 }, radius);
}
}

TEST(SurfaceCheck, AcceptsValidSurfaces)
{
  EXPECT_EQ(ErrorOf(Ball()), "");
  EXPECT_EQ(ErrorOf(MakeTorus({ 0, 0, 0 }, 5, 2, 20, 10)), "");
  IndexedSurface hollow = Ball(0, 4);
  AddSurface(hollow, InsideOut(Ball()));
  AddSurface(hollow, Ball(10));
  EXPECT_EQ(ErrorOf(hollow), "") << "cavities and several components are legal";
  IndexedSurface loose = Ball();
  loose.Points.push_back({ 9, 9, 9 });
  EXPECT_EQ(ErrorOf(loose), "") << "points without triangles do no harm";
}

TEST(SurfaceCheck, RejectsInvalidIndicesAndCoordinates)
{
  EXPECT_TRUE(Has(ErrorOf({}), "is empty"));
  for (const int corner : { -1, 12, std::numeric_limits<int>::max() })
  {
    IndexedSurface surface = Ball();
    surface.Triangles[7][1] = corner;
    EXPECT_TRUE(Has(ErrorOf(surface), "triangle 7 has point " + std::to_string(corner)));
  }
  for (const double x : { std::nan(""), HUGE_VAL, -HUGE_VAL })
  {
    IndexedSurface surface = Ball();
    surface.Points[5][2] = x;
    EXPECT_TRUE(Has(ErrorOf(surface), "not finite at point 5"));
  }
}

TEST(SurfaceCheck, RejectsDegenerateTriangles)
{
  for (int k = 0; k < 3; ++k)
  {
    IndexedSurface surface = Ball();
    surface.Triangles[4][k] = surface.Triangles[4][(k + 1) % 3];
    EXPECT_TRUE(Has(ErrorOf(surface), "degenerate triangle: triangle 4 uses a point twice"));
  }
}

TEST(SurfaceCheck, RejectsOpenNonManifoldAndMisorientedEdges)
{
  IndexedSurface open = Ball();
  open.Triangles.erase(open.Triangles.begin() + 3);
  EXPECT_TRUE(Has(ErrorOfTopology(open), "is not closed: 3 edges"));
  // Two tetrahedra that share an edge but no triangle. Every other edge has two triangles.
  IndexedSurface hinge;
  hinge.Points = { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0.6, 1, 0.5 }, { -1, 0, 0 },
    { -0.6, -1, 0.5 } };
  hinge.Triangles = { { 0, 3, 2 }, { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 5, 4 }, { 0, 4, 1 },
    { 0, 1, 5 }, { 1, 4, 5 } };
  EXPECT_TRUE(Has(ErrorOfTopology(hinge), "1 edges have more than two triangles"));
  IndexedSurface twisted = Ball();
  std::swap(twisted.Triangles[3][0], twisted.Triangles[3][1]);
  EXPECT_TRUE(Has(ErrorOfTopology(twisted), "is not consistently oriented: 3 edges"));
}

TEST(SurfaceCheck, RejectsNonManifoldVertices)
{
  // Two balls with one point in common.
  IndexedSurface surface = Ball();
  AddSurface(surface, Ball(10));
  for (Triangle& t : surface.Triangles)
  {
    for (int& corner : t)
    {
      corner = corner == 12 + 10 ? 9 : corner;
    }
  }
  surface.Points[9] = { 5, 0, 0 };
  EXPECT_TRUE(Has(ErrorOfTopology(surface), "1 points join several triangle fans"));
}

TEST(SurfaceCheck, RejectsNonPositiveVolume)
{
  EXPECT_TRUE(Has(ErrorOf(InsideOut(Ball())), "is inside out"));
  IndexedSurface mostly = InsideOut(Ball(0, 4));
  AddSurface(mostly, Ball(10));
  EXPECT_TRUE(Has(ErrorOf(mostly), "is inside out"));
  IndexedSurface pillow; // Two triangles back to back.
  pillow.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  pillow.Triangles = { { 0, 1, 2 }, { 0, 2, 1 } };
  EXPECT_TRUE(Has(ErrorOf(pillow), "encloses no volume"));
}

TEST(SurfaceCheck, RejectsSelfIntersections)
{
  IndexedSurface crossing = Ball();
  AddSurface(crossing, Ball(2.3));
  const int pairs = CountSelfIntersections(crossing);
  EXPECT_GT(pairs, 5);
  EXPECT_TRUE(Has(ErrorOf(crossing), "intersects itself: " + std::to_string(pairs) + " pairs"));
}

TEST(SurfaceCheck, RejectsSurfacesOutsideImage)
{
  EXPECT_EQ(OutsideErrorOf(Icosahedron({ 10, 10, 20 }, 3)), "");
  EXPECT_EQ(OutsideErrorOf(Icosahedron({ -2, 10, 20 }, 3)), "") << "partly";
  EXPECT_EQ(OutsideErrorOf(Icosahedron({ 10, 10, 38 }, 3)), "");
  EXPECT_TRUE(Has(OutsideErrorOf(Icosahedron({ -10, 10, 20 }, 3)), "along axis 0"));
  EXPECT_TRUE(Has(OutsideErrorOf(Icosahedron({ 10, 30, 20 }, 3)), "along axis 1"));
  EXPECT_TRUE(Has(OutsideErrorOf(Icosahedron({ 10, 10, 50 }, 3)), "along axis 2"));
}
