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

TEST(StartIsoSurface, WithEdgesThatAreTooLongKeepsItsPoints)
{
  // As where voxels are long: a lattice in its place would have other points, and costs more.
  const TestVolume volume = DistanceToBall(9.2);
  const IndexedSurface coarse = DividedIcosahedron(Middle, 9.2, 5.);
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  evolution.StartIsoSurface(volume.Image, 0, coarse);
  const SurfaceResult start = evolution.Result();
  EXPECT_GT(start.Points.size(), 2 * coarse.Points.size());
  for (const Point& p : coarse.Points)
  {
    const bool isThere = std::any_of(start.Points.begin(), start.Points.end(), [&p](const Point& q)
      { return Distance(p[0], p[1], p[2], q[0], q[1], q[2]) < 1e-4; });
    EXPECT_TRUE(isThere) << p[0] << ' ' << p[1] << ' ' << p[2];
  }
}
