// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

using namespace volumic;

TEST(DeformableSurface, FindsABallInAnImage)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
  EXPECT_EQ(StopReason(filter->GetOutput()), "converged");
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 0);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Genus"), 0);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "EulerCharacteristic"), 2);
}

TEST(DeformableSurface, IsInWorldCoordinates)
{
  const auto image = BallImage(40, 36, 40, 0.3);
  image->SetExtent(5, 44, -9, 26, 100, 139);
  image->SetOrigin(-300, 50, 1000);
  image->SetSpacing(0.5, 0.5, 0.5);
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  const double direction[9] = { c, -s, 0, s, c, 0, 0, 0, 1 };
  image->SetDirectionMatrix(direction);
  const auto filter = SurfaceOf(image);
  const double index[3] = { 5 + 19.5, -9 + 17.5, 100 + 19.5 };
  double centre[3];
  image->TransformContinuousIndexToPhysicalPoint(index, centre);
  ExpectSphere(filter->GetOutput(), centre, 0.3 * 36 * 0.5, 0.1);
  EXPECT_NEAR(FieldOf(filter->GetOutput(), "Unit"), 0.5, 1e-12);
}

TEST(DeformableSurface, ClosesAtTheBorderOfTheImage)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40, 0.6));
  EXPECT_EQ(OpenOrNonManifoldEdges(filter->GetOutput()), 0);
  const double* bounds = filter->GetOutput()->GetBounds();
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(bounds[2 * axis], -0.5, 0.6);
    EXPECT_NEAR(bounds[2 * axis + 1], 39.5, 0.6);
  }
}

TEST(DeformableSurface, IsBitIdenticalForAnyNumberOfThreadsAndRuns)
{
  const auto image = BallImage(48, 48, 48);
  const auto one = SurfaceOf(image, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(1); });
  for (const int threads : { 1, 2, 3 })
  {
    const auto other =
      SurfaceOf(image, [&](vtkDeformableSurface* f) { f->SetNumberOfThreads(threads); });
    ASSERT_GT(other->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(AreSameSurfaces(other->GetOutput(), one->GetOutput())) << threads << " threads";
  }
}
