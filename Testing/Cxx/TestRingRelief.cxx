// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/RingRelief.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
/** A lens: a point above and one below two rings of so many. */
IndexedSurface Lens(int sides, double height)
{
  IndexedSurface surface;
  surface.Points = { { 0., 0., height }, { 0., 0., -height } };
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2. * 3.14159265358979 * i / sides;
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    surface.Points.push_back({ x, y, 0.1 });
    surface.Points.push_back({ x, y, -0.1 });
    const int upper = 2 + 2 * i;
    const int next = 2 + 2 * ((i + 1) % sides);
    surface.Triangles.push_back({ 0, upper, next });
    surface.Triangles.push_back({ 1, next + 1, upper + 1 });
    surface.Triangles.push_back({ upper, upper + 1, next + 1 });
    surface.Triangles.push_back({ upper, next + 1, next });
  }
  return surface;
}

int MostNeighbours(const IndexedSurface& surface)
{
  std::vector<int> valence(surface.Points.size(), 0);
  for (const Triangle& t : surface.Triangles)
  {
    for (const int corner : t)
    {
      ++valence[static_cast<std::size_t>(corner)];
    }
  }
  return *std::max_element(valence.begin(), valence.end());
}
}

TEST(RelieveRings, TakesNeighboursFromThoseThatHaveTooMany)
{
  IndexedSurface surface = Lens(22, 0.2);
  const SurfaceFeatures before = ComputeFeatures(surface);
  ASSERT_GT(MostNeighbours(surface), Ring::Capacity);
  EXPECT_TRUE(RelieveRings(surface));
  EXPECT_LE(MostNeighbours(surface), Ring::Capacity);
  const SurfaceFeatures after = ComputeFeatures(surface);
  EXPECT_EQ(after.EulerCharacteristic, 2);
  EXPECT_EQ(after.Components.size(), 1u);
  EXPECT_NEAR(after.Volume, before.Volume, 0.05 * before.Volume) << "oriented as it was";
  EXPECT_EQ(CountSelfIntersections(surface), 0);
}

TEST(RelieveRings, TellsWhereItCannot)
{
  // Needles: any other edge would fold them.
  IndexedSurface surface = Lens(22, 60.);
  EXPECT_FALSE(RelieveRings(surface));
}
