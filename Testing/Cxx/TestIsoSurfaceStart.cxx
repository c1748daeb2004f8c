// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
const Point Middle = { 16., 16., 16. };

/** The distance to a ball about the middle, positive inside. */
TestVolume DistanceToBall(double radius)
{
  return MakeVolume(32, [radius](double x, double y, double z)
    { return std::clamp(radius - Distance(x, y, z, 16., 16., 16.), -4., 4.); });
}
}

TEST(StartIsoSurface, IsNearTheBoundaryWithEvenTriangles)
{
  const TestVolume volume = DistanceToBall(9.2);
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  evolution.StartIsoSurface(volume.Image, 0);
  const SurfaceResult start = evolution.Result();
  EXPECT_EQ(evolution.Now->Components.NumberOfComponents(), 1);
  for (const Point& p : start.Points)
  {
    EXPECT_NEAR(Distance(p[0], p[1], p[2], Middle[0], Middle[1], Middle[2]), 9.6, 0.5);
  }
}

TEST(StartIsoSurface, HasEvenTheSmallestParts)
{
  // A voxel, beside the ball.
  const TestVolume volume = MakeVolume(32,
    [](double x, double y, double z)
    {
      const bool isAlone = x == 3. && y == 4. && z == 5.;
      return isAlone ? 1. : std::clamp(6. - Distance(x, y, z, 16., 16., 16.), -1., 1.);
    });
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  evolution.StartIsoSurface(volume.Image, 0);
  EXPECT_EQ(evolution.Now->Components.NumberOfComponents(), 2);
}

TEST(StartIsoSurface, RefusesALevelWithoutTheObject)
{
  const TestVolume volume = MakeVolume(16, [](double, double, double) { return -1.; });
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  EXPECT_THROW(evolution.StartIsoSurface(volume.Image, 0), std::invalid_argument);
}
