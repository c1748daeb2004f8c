// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Metric and EdgeLength of the surface's filters: which lengths are even, and how long they are.
#include "SurfaceTestTools.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
vtkSmartPointer<vtkImageData> FlatBall(double zSpacing)
{
  // A ball in the world: an ellipsoid in voxels.
  const auto image = ImageOf({ 48, 48, 24 },
    [=](int i, int j, int k)
    {
      const double distance = std::hypot(i - 23.5, j - 23.5, zSpacing * (k - 11.5));
      return std::clamp(50. + 12. * (16. - distance), 0., 100.);
    });
  image->SetSpacing(1, 1, zSpacing);
  return image;
}

vtkSmartPointer<vtkPolyData> SurfaceIn(int metric, vtkImageData* image)
{
  return SurfaceOf(image, [metric](vtkDeformableSurface* f) { f->SetMetric(metric); })->GetOutput();
}
}

TEST(Metric, HasNoEffectOnCubicVoxels)
{
  const auto image = BallImage(40, 40, 40);
  image->SetSpacing(0.3, 0.3, 0.3);
  EXPECT_TRUE(AreSameSurfaces(
    SurfaceIn(vtkDeformableSurface::World, image), SurfaceIn(vtkDeformableSurface::Voxels, image)));
}

TEST(Metric, AppliesToRotatedAndMirroredImages)
{
  const auto image = FlatBall(2.);
  const double direction[9] = { 0, 0, -1, 1, 0, 0, 0, 1, 0 };
  image->SetDirectionMatrix(direction);
  const auto surface = SurfaceIn(vtkDeformableSurface::World, image);
  const double index[3] = { 23.5, 23.5, 11.5 };
  double centre[3];
  image->TransformContinuousIndexToPhysicalPoint(index, centre);
  ExpectSphere(surface, centre, 16., 0.4);
  const std::vector<double> edges = EdgeLengthsOf(surface);
  EXPECT_GE(edges.front(), 0.999 * 0.85);
  EXPECT_LE(edges.back(), 2.501 * 0.85);
}

TEST(Metric, RecoversPartsAcrossThickSlices)
{
  // A needle along z that no coarse level shows, beside a ball that they do.
  const double stretch = 4.;
  const auto image = FlatBall(stretch);
  FillBox(image, { 4, 4, 2 }, { 7, 7, 22 }, 90.);
  const auto surface = SurfaceIn(vtkDeformableSurface::World, image);
  EXPECT_EQ(FieldOf(surface, "NumberOfComponents"), 2) << "the needle in one piece";
  EXPECT_EQ(FieldOf(surface, "Genus"), 0);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  const double* bounds = surface->GetBounds();
  EXPECT_NEAR(bounds[0], 3.5, 0.6);
  EXPECT_NEAR(bounds[4], 1.5 * stretch, 0.6 * stretch);
}

TEST(EdgeLength, IsMetFromLevelMinus1ToCoarseLevels)
{
  const auto image = BallImage(64, 64, 64);
  image->SetSpacing(0.5, 0.5, 0.5);
  for (const double length : { 0.4, 0.75, 1.2, 2.3, 3.2 })
  {
    const auto filter = FilterOf<vtkVolumeToSurface>(image);
    filter->SetEdgeLength(length);
    filter->SetFinestLevel(7); // not looked at
    filter->Update();
    vtkPolyData* surface = filter->GetOutput();
    ASSERT_GT(surface->GetNumberOfPoints(), 30) << length;
    EXPECT_NEAR(MeanEdgeOf(surface), length, 0.15 * length) << length;
    const double ratio = FieldOf(surface, "Delta") / FieldOf(surface, "Unit");
    EXPECT_GE(ratio, std::sqrt(3.) / 2.5 - 1e-6) << "eq. (7)";
    EXPECT_LE(ratio, 1. + 1e-6);
  }
}

TEST(EdgeLength, UsesTheLevelsOfAnInputPyramid)
{
  const auto pyramid = PyramidOf(BallImage(64, 64, 64));
  const auto filter =
    SurfaceOf(pyramid->GetOutput(), [](vtkDeformableSurface* f) { f->SetEdgeLength(2.6); });
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1);
  EXPECT_NEAR(MeanEdgeOf(filter->GetOutput()), 2.6, 0.4);
  // Between what levels 0 and 1 can give.
  filter->SetEdgeLength(1.85);
  ExpectErrorOf(
    filter, { "Edge Length is 1.85", "to 1.7, 2.0", "the image instead of its pyramid" });
}

TEST(EdgeLength, ReportsImpossibleLengths)
{
  const auto filter = FilterOf<vtkVolumeToSurface>(BallImage(40, 40, 40));
  filter->SetEdgeLength(0.1);
  ExpectErrorOf(filter, { "Edge Length is 0.1, but edges of this image can have mean lengths" });
  filter->SetEdgeLength(1000.);
  ExpectErrorOf(filter, { "Give a shorter one, or allow coarser levels by Minimum Level Size" });
  filter->SetEdgeLength(-2.);
  ExpectErrorOf(filter, { "Edge Length is -2; it must be 0 (automatic) or a length" });
  filter->SetEdgeLength(3.);
  filter->SetCoarsestLevel(0);
  ExpectErrorOf(
    filter, { "Edge Length is 3, for which the finest level is 1, but Coarsest Level is 0" });
  filter->SetCoarsestLevel(-1);
  EXPECT_EQ(MessagesOfUpdate(filter), "");
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 30);
}
