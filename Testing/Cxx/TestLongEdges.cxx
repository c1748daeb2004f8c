// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LongEdges.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
/** Edges of all lengths: triangles with one, two and three that are too long. */
IndexedSurface Box(double x, double y, double z)
{
  IndexedSurface box;
  for (int corner = 0; corner < 8; ++corner)
  {
    box.Points.push_back({ corner % 2 ? x : 0., corner / 2 % 2 ? y : 0., corner / 4 ? z : 0. });
  }
  box.Triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
    { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return box;
}

double LongestEdge(const IndexedSurface& surface)
{
  double longest = 0.;
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point& p = surface.Points[t[k]];
      const Point& q = surface.Points[t[(k + 1) % 3]];
      longest = std::max(longest, std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]));
    }
  }
  return longest;
}
}

TEST(HalveLongEdges, LeavesTheSurfaceWhereItIs)
{
  IndexedSurface box = Box(16., 3., 1.);
  HalveLongEdges(box, 2.);
  EXPECT_LE(LongestEdge(box), 2.);
  EXPECT_GT(LongestEdge(box), 1.);
  const SurfaceFeatures after = ComputeFeatures(box);
  EXPECT_EQ(after.Components.size(), 1u);
  EXPECT_EQ(after.EulerCharacteristic, 2) << "each middle is one point of two triangles";
  EXPECT_DOUBLE_EQ(after.Volume, 48.) << "oriented as it was";
  EXPECT_DOUBLE_EQ(after.Area, 134.);
  EXPECT_EQ(CountSelfIntersections(box), 0);
}
