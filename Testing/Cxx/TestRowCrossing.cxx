// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/RowCrossing.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
/** With corners on the axes, as far from the origin as the size says. */
IndexedSurface Octahedron(double size)
{
  return { { { size, 0, 0 }, { -size, 0, 0 }, { 0, size, 0 }, { 0, -size, 0 }, { 0, 0, size },
             { 0, 0, -size } },
    { { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 }, { 2, 0, 5 }, { 1, 2, 5 }, { 3, 1, 5 },
      { 0, 3, 5 } } };
}

std::vector<RowCrossing> CrossingsOf(const IndexedSurface& surface, double y, double z)
{
  std::vector<RowCrossing> crossings;
  for (const Triangle& t : surface.Triangles)
  {
    const RowCrossing crossing = RowCrossing::Of(
      surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]], y, z);
    if (crossing.Winding != 0)
    {
      crossings.push_back(crossing);
    }
  }
  return crossings;
}
}

TEST(RowCrossing, TellsWhereALineEntersAndLeaves)
{
  const IndexedSurface surface = Octahedron(4);
  for (const double y : { 1., -0.5 })
  {
    const std::vector<RowCrossing> crossings = CrossingsOf(surface, y, 0.25);
    ASSERT_EQ(crossings.size(), 2u);
    for (const RowCrossing& crossing : crossings)
    {
      EXPECT_EQ(crossing.Winding, crossing.X < 0 ? 1 : -1);
      EXPECT_NEAR(std::abs(crossing.X), 4 - std::abs(y) - 0.25, 1e-12);
    }
  }
  EXPECT_TRUE(CrossingsOf(surface, 3, 1.5).empty());
}

TEST(RowCrossing, CountsOnceAtEdgesAndCorners)
{
  const IndexedSurface surface = Octahedron(4);
  // Through two corners, and along the planes of four edges each.
  for (const Point& p : std::vector<Point>{ { 0, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 },
         { 0, 0, -1 } })
  {
    const std::vector<RowCrossing> crossings = CrossingsOf(surface, p[1], p[2]);
    ASSERT_EQ(crossings.size(), 2u) << p[1] << " " << p[2];
    EXPECT_EQ(crossings[0].Winding + crossings[1].Winding, 0);
    EXPECT_NEAR(crossings[0].X + crossings[1].X, 0, 1e-12);
  }
  // The corners at the sides are either passed by, or entered and left at once.
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
