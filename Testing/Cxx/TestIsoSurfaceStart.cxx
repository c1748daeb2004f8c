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

TEST(StartIsoSurface, IsTheStartFromAGivenSurfaceWithoutItsTests)
{
  const TestVolume volume = DistanceToBall(9.2);
  const IndexedSurface sphere = DividedIcosahedron(Middle, 9.2, 1.2);
  TestEvolution tested(SurfaceOptions(), Threads, Silent);
  tested.StartSurface(volume.Image, 0, sphere);
  TestEvolution known(SurfaceOptions(), Threads, Silent);
  known.StartIsoSurface(volume.Image, 0, sphere);
  EXPECT_EQ(known.Result().Points, tested.Result().Points);
  EXPECT_EQ(known.Result().Triangles, tested.Result().Triangles);
  EXPECT_THROW(known.StartIsoSurface(volume.Image, 0, IndexedSurface()), std::invalid_argument);
}
