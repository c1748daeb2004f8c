// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
/** A ball far from the origin, of more than one block of vertices, with a cavity. */
SurfaceMesh HollowBall()
{
  SurfaceMesh mesh;
  mesh.Append(DividedIcosahedron({ 60, 50, 40 }, 12, 0.6));
  mesh.Append(InsideOut(DividedIcosahedron({ 62, 50, 40 }, 6, 0.6)));
  return mesh;
}
}

TEST(SurfaceMeasures, AreThoseOfTheTriangles)
{
  SurfaceMesh mesh = HollowBall();
  ASSERT_GT(mesh.Size(), 4096);
  const SurfaceFeatures features = ComputeFeatures(mesh.ToIndexed());
  SequentialExecutor sequential;
  EXPECT_NEAR(EnclosedVolume(mesh, sequential), features.Volume, 1e-9 * features.Volume);
  EXPECT_NEAR(SurfaceArea(mesh, sequential), features.Area, 1e-6 * features.Area);
}

TEST(SurfaceMeasures, VolumeOfACavityIsNegative)
{
  SurfaceMesh mesh;
  mesh.Append(InsideOut(DividedIcosahedron({ 5, 6, 7 }, 2, 0.5)));
  SequentialExecutor sequential;
  const double volume = EnclosedVolume(mesh, sequential);
  EXPECT_LT(volume, -30);
  EXPECT_GT(volume, -4. / 3. * 3.1415927 * 8);
  // Wherever the origin is.
  SignedVolume elsewhere(Vector(-3, 4, 9));
  for (int v = 0; v < mesh.Size(); ++v)
  {
    elsewhere.Add(mesh, v);
  }
  EXPECT_NEAR(elsewhere.Value(), volume, 1e-9);
  double byFaces = 0.;
  mesh.VisitFaces([&](int a, int b, int c)
    { byFaces += SignedVolume::OfFace(mesh, VectorD(1, 2, 3), a, b, c) / 6.; });
  EXPECT_NEAR(byFaces, volume, 1e-9);
}
