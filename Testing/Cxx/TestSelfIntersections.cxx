// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Mesh/TriangleTree.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
/** Return a cube of 12 triangles, rotated so that no face is axis-aligned. */
IndexedSurface TurnedCube(const Point& centre, double half)
{
  IndexedSurface cube = Cuboid({ -half, -half, -half }, { half, half, half });
  const double c = 0.6;
  const double s = 0.8;
  for (Point& p : cube.Points)
  {
    const double u = c * p[0] - s * p[1];
    const double v = s * p[0] + c * p[1];
    p = { centre[0] + u, centre[1] + c * v - s * p[2], centre[2] + s * v + c * p[2] };
  }
  return cube;
}

/** Return disconnected triangles with sizes from 0.01 to 3 in a cube of side 4. */
IndexedSurface MixedSoup(int count, unsigned int seed)
{
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> position(0., 4.);
  std::uniform_real_distribution<double> offset(-1., 1.);
  std::uniform_real_distribution<double> power(-2., 0.5);
  IndexedSurface soup;
  for (int i = 0; i < count; ++i)
  {
    const Point centre = { position(engine), position(engine), position(engine) };
    const double size = std::pow(10., power(engine));
    for (int k = 0; k < 3; ++k)
    {
      soup.Points.push_back({ centre[0] + size * offset(engine), centre[1] + size * offset(engine),
        centre[2] + size * offset(engine) });
    }
    soup.Triangles.push_back({ 3 * i, 3 * i + 1, 3 * i + 2 });
  }
  return soup;
}

MeshTriangle Rounded(const IndexedSurface& surface, int i)
{
  MeshTriangle triangle;
  for (int k = 0; k < 3; ++k)
  {
    triangle.Vertex[k] = surface.Triangles[i][k];
    const Point& p = surface.Points[triangle.Vertex[k]];
    triangle.Corner[k] =
      VectorD(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  return triangle;
}
}

TEST(SelfIntersections, MatchBruteForce)
{
  for (unsigned int seed : { 1u, 2u, 3u })
  {
    const IndexedSurface soup = MixedSoup(400, seed);
    int expected = 0;
    for (int i = 0; i < 400; ++i)
    {
      for (int j = i + 1; j < 400; ++j)
      {
        expected += TrianglesIntersect(Rounded(soup, i), Rounded(soup, j), 1e-9);
      }
    }
    ASSERT_GT(expected, 20);
    EXPECT_EQ(CountSelfIntersections(soup), expected);
    EXPECT_EQ(CountSelfIntersections(soup, 7), 7) << "stops at the limit";
  }
}

TEST(SelfIntersections, SkipBoxesNotCutByPlane)
{
  // The boxes of these triangles contain the sphere, but their planes do not cut it.
  const IndexedSurface sphere = DividedIcosahedron({ 0, 0, 0 }, 1, 0.02);
  IntersectionCounters own;
  EXPECT_EQ(CountSelfIntersections(sphere, 0, &own), 0);
  IndexedSurface surface;
  constexpr int sheets = 100;
  for (int i = 0; i < sheets; ++i)
  {
    const double x = 350. + i;
    surface.Points.insert(
      surface.Points.end(), { { x, -100, -100 }, { -100, x, -100 }, { -100, -100, x } });
    surface.Triangles.push_back({ 3 * i, 3 * i + 1, 3 * i + 2 });
  }
  AddSurface(surface, sphere);
  IntersectionCounters counters;
  EXPECT_EQ(CountSelfIntersections(surface, 0, &counters), 0);
  EXPECT_LT(
    counters.Pairs, own.Pairs + sheets * static_cast<long long>(sphere.Triangles.size()) / 3);
  // A cube that intersects the sphere is detected.
  IndexedSurface crossing = DividedIcosahedron({ 0, 0, 0 }, 1, 0.1);
  AddSurface(crossing, TurnedCube({ 60.3, 48.24, 64.32 }, 100));
  EXPECT_GT(CountSelfIntersections(crossing), 0);
}

TEST(TriangleTree, ComputesDistanceToNearestTriangle)
{
  const IndexedSurface cube = TurnedCube({ 5, 5, 5 }, 2);
  const TriangleTree tree(cube);
  EXPECT_NEAR(std::sqrt(tree.SquaredDistance({ 5, 5, 5 })), 2., 1e-9) << "to the faces";
  const Point& corner = cube.Points[0];
  const Point beyond = { 2 * corner[0] - 5, 2 * corner[1] - 5, 2 * corner[2] - 5 };
  EXPECT_NEAR(std::sqrt(tree.SquaredDistance(beyond)), 2 * std::sqrt(3.), 1e-9) << "to a corner";
  const IndexedSurface sphere = DividedIcosahedron({ 0, 0, 0 }, 10, 1.);
  const TriangleTree round(sphere);
  EXPECT_NEAR(std::sqrt(round.SquaredDistance({ 20, 1, -3 })), std::sqrt(410.) - 10, 0.05);
}
