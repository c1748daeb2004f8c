// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "SurfaceFeatures.h"

#include <gtest/gtest.h>

using namespace volumic;

namespace
{
/** The box [0, a] x [0, b] x [0, c], moved. */
IndexedSurface Box(double a, double b, double c, const Point& at)
{
  IndexedSurface box;
  for (int i = 0; i < 8; ++i)
  {
    box.Points.push_back({ at[0] + a * (i & 1), at[1] + b * (i >> 1 & 1), at[2] + c * (i >> 2) });
  }
  box.Triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
    { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  return box;
}
}

TEST(SurfaceFeatures, OfABox)
{
  const SurfaceFeatures features = ComputeFeatures(Box(2, 3, 4, { 10, 20, 30 }));
  ASSERT_EQ(features.Components.size(), 1u);
  const ComponentFeatures& box = features.Components[0];
  EXPECT_NEAR(box.Area, 2 * (6 + 8 + 12), 1e-9);
  EXPECT_NEAR(box.Volume, 24, 1e-9);
  EXPECT_EQ(box.Genus, 0);
  EXPECT_NEAR(box.Centroid[0], 11, 1e-9);
  EXPECT_NEAR(box.Centroid[1], 21.5, 1e-9);
  EXPECT_NEAR(box.Centroid[2], 32, 1e-9);
  EXPECT_NEAR(box.Inertia[0], 24. / 12 * (9 + 16), 1e-8);
  EXPECT_NEAR(box.Inertia[1], 24. / 12 * (4 + 16), 1e-8);
  EXPECT_NEAR(box.Inertia[2], 24. / 12 * (4 + 9), 1e-8);
  for (int k = 3; k < 6; ++k)
  {
    EXPECT_NEAR(box.Inertia[k], 0, 1e-8);
  }
}

TEST(SurfaceFeatures, SortsComponentsByAreaAndSignsCavities)
{
  IndexedSurface surface = Box(2, 2, 2, { 4, 4, 4 });
  for (Triangle& t : surface.Triangles)
  {
    std::swap(t[0], t[1]); // A cavity.
  }
  const IndexedSurface outer = Box(10, 10, 10, { 0, 0, 0 });
  for (const Triangle& t : outer.Triangles)
  {
    surface.Triangles.push_back({ t[0] + 8, t[1] + 8, t[2] + 8 });
  }
  surface.Points.insert(surface.Points.end(), outer.Points.begin(), outer.Points.end());
  const SurfaceFeatures features = ComputeFeatures(surface);
  ASSERT_EQ(features.Components.size(), 2u);
  EXPECT_NEAR(features.Components[0].Volume, 1000, 1e-6);
  EXPECT_NEAR(features.Components[1].Volume, -8, 1e-9);
  EXPECT_NEAR(features.Volume, 992, 1e-6);
  EXPECT_EQ(features.ComponentOfTriangle.front(), 1);
  EXPECT_EQ(features.ComponentOfTriangle.back(), 0);
  EXPECT_EQ(features.EulerCharacteristic, 4);
}

TEST(SurfaceFeatures, CountsHandles)
{
  const SurfaceFeatures features = ComputeFeatures(MakeTorus({ 1, 2, 3 }, 5, 2, 60, 40));
  ASSERT_EQ(features.Components.size(), 1u);
  EXPECT_EQ(features.Genus, 1);
  EXPECT_EQ(features.EulerCharacteristic, 0);
  const double exact = 2 * 3.14159265 * 3.14159265 * 5 * 4;
  EXPECT_NEAR(features.Volume, exact, 0.02 * exact);
}
