// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkTable.h>

using namespace volumic;

TEST(DeformableSurfaceStart, StartsFromAnInputSurface)
{
  const auto filter = FilterOf(BallImage(40, 40, 40));
  filter->SetInitializationToInputSurface();
  filter->SetInitialSurfaceData(SphereAt({ 22, 19, 19 }, 14, 24));
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
}

TEST(DeformableSurfaceStart, SeedsAreNotLargerThanTheImage)
{
  const auto surfaceOf = [](double radius)
  {
    return Updated<vtkDeformableSurface>(BallImage(12, 12, 12),
      [radius](vtkDeformableSurface* filter)
      {
        filter->SetIsoValue(50.0);
        filter->SetInitializationToSeeds();
        filter->SetSeedRadius(radius);
      });
  };
  EXPECT_TRUE(AreSameSurfaces(surfaceOf(1e9)->GetOutput(), surfaceOf(50.0)->GetOutput()));
}

namespace
{
/** The coarsest level that has a surface. */
unsigned int FirstLevelOf(vtkDeformableSurface* filter)
{
  unsigned int first = filter->GetLevels()->GetNumberOfBlocks() - 1;
  while (!filter->GetLevels()->GetBlock(first))
  {
    --first;
  }
  return first;
}

/** A ball with a ramp of about a voxel, 100 inside. */
vtkSmartPointer<vtkImageData> BallOfRadius(double radius)
{
  return ImageOf({ 40, 40, 40 },
    [radius](int i, int j, int k)
    { return 100.0 * std::clamp(0.5 + radius - std::hypot(i - 20, j - 20, k - 20), 0.0, 1.0); });
}

/**
 * A ball and sheets of one voxel around it, which coarse levels miss and level 0 does not resolve.
 */
vtkSmartPointer<vtkImageData> BallAndSheets(int sheets)
{
  const auto image = BallImage(64, 64, 64, 0.25);
  for (int sheet = 0; sheet < sheets; ++sheet)
  {
    FillBox(image, { 4 + 4 * sheet, 10, 10 }, { 5 + 4 * sheet, 54, 54 }, 62.0);
  }
  return image;
}
}

TEST(DeformableSurfaceStart, RecoversCavities)
{
  // A bubble in the ball, which a surface from outside cannot reach.
  const auto image = BallImage(64, 64, 64, 0.4);
  FillBox(image, { 24, 25, 26 }, { 39, 40, 41 }, 0.0);
  for (int recovery :
    { vtkDeformableSurface::RecoverObjects, vtkDeformableSurface::RecoverObjectsAndCavities })
  {
    SCOPED_TRACE(recovery);
    const bool requested = recovery == vtkDeformableSurface::RecoverObjectsAndCavities;
    const auto filter =
      SurfaceOf(image, [&](vtkDeformableSurface* f) { f->SetRecovery(recovery); });
    vtkPolyData* surface = filter->GetOutput();
    ASSERT_EQ(FieldOf(surface, "NumberOfComponents"), requested ? 2 : 1);
    EXPECT_EQ(FieldOf(surface, "Genus"), 0);
    if (requested)
    {
      EXPECT_NEAR(FieldOf(surface, "ComponentVolume", 1) / std::pow(-15.0, 3), 1.0, 0.08);
    }
  }
}

TEST(DeformableSurfaceStart, StartsAroundTheFirstResolvedParts)
{
  // A shell that coarse levels do not resolve, far from an enclosing box.
  const auto image = ImageOf({ 64, 64, 64 },
    [](int i, int j, int k)
    {
      const double distance = std::hypot(i - 32.0, j - 31.0, k - 33.0);
      return std::clamp(100.0 * (1.3 - std::abs(distance - 24.0)), 0.0, 100.0);
    });
  const auto filter = SurfaceOf(image, [](vtkDeformableSurface* f) { f->SetIsoValue(50.5); });
  const unsigned int first = FirstLevelOf(filter);
  ASSERT_LT(first, filter->GetLevels()->GetNumberOfBlocks() - 1);
  vtkPolyData* start = SurfaceAt(filter, first);
  EXPECT_GE(FieldOf(start, "LostParts"), 1) << "as the coarser levels have lost it";
  EXPECT_EQ(FieldOf(start, "RecoveredParts"), FieldOf(start, "LostParts"));
  const double iterations = FieldOf(start, "Iterations");
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 2) << "both its walls";
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Genus"), 0);
  // With a given CoarsestLevel the run starts from the box.
  filter->SetCoarsestLevel(static_cast<int>(first));
  filter->Update();
  EXPECT_EQ(FieldOf(SurfaceAt(filter, first), "LostParts"), 0);
  EXPECT_GE(FieldOf(SurfaceAt(filter, first), "Iterations"), 2 * iterations);
}

TEST(DeformableSurfaceStart, SkipsLevelsWithSmallPartsOnly)
{
  // A rod with a bright middle. The first level that resolves it has only its middle, with fewer
  // voxels than MinimumPartSize.
  const auto image = ImageOf({ 64, 64, 64 }, [](int, int, int) { return 0.0; });
  FillBox(image, { 8, 30, 30 }, { 56, 33, 33 });
  FillBox(image, { 30, 30, 30 }, { 33, 33, 33 }, 400.0);
  const auto filter = SurfaceOf(image, [](vtkDeformableSurface* f) { f->SetIsoValue(50.5); });
  const unsigned int first = FirstLevelOf(filter);
  EXPECT_GE(FieldOf(SurfaceAt(filter, first), "RecoveredParts"), 1);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
  // If no level has a part of this size, the run starts at the first level with any voxel.
  filter->SetMinimumPartSize(100000);
  filter->Update();
  EXPECT_TRUE(filter->GetLevels()->GetBlock(first + 1)) << "one that was left out";
}

TEST(DeformableSurfaceStart, WithoutRecoveryStartsAtALevelWithALargePart)
{
  // The coarsest levels have too few voxels of the object for a surface.
  for (const double radius : { 2.5, 3.5, 4.5 })
  {
    SCOPED_TRACE(radius);
    const auto filter = FilterOf(BallOfRadius(radius));
    filter->SetRecovery(vtkDeformableSurface::NoRecovery);
    EXPECT_EQ(MessagesOfUpdate(filter, vtkCommand::WarningEvent), "");
    EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
    EXPECT_NEAR(FieldOf(filter->GetOutput(), "Volume") / VolumeOfBall(radius), 1.0, 0.25);
  }
}

TEST(DeformableSurfaceStart, WithoutRecoveryEndsAtTheFinestLevelAtLeast)
{
  // The object is too thin for a surface at any level. The run starts at the finest level.
  const auto filter = FilterOf(BallOfRadius(0.8));
  filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  const MessagesOf errors(filter);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_EQ(errors.Get(), "");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(Has(warnings.Get(), "The surface has vanished at level 0"));
  EXPECT_TRUE(Has(warnings.Get(), "Check Iso Value and Object Is Bright"));
  EXPECT_FALSE(Has(warnings.Get(), "Set CoarsestLevel"));
}

TEST(DeformableSurfaceStart, StartsFromTheIsoSurfaceWhereAllVoxelsAreObject)
{
  // Level 0 has a few dark voxels; at the coarsest level there is nothing but object.
  for (const bool isBright : { true, false })
  {
    const auto image = BallOfRadius(1.5);
    vtkDataArray* voxels = Voxels(image);
    for (vtkIdType voxel = 0; isBright && voxel < voxels->GetNumberOfTuples(); ++voxel)
    {
      voxels->SetComponent(voxel, 0, 100.0 - voxels->GetComponent(voxel, 0));
    }
    const auto filter = FilterOf(image);
    filter->SetIsoValue(isBright ? 20.0 : 80.0);
    filter->SetObjectIsBright(isBright);
    filter->SetInitializationToIsoSurface();
    EXPECT_EQ(MessagesOfUpdate(filter), "");
    EXPECT_EQ(OpenOrNonManifoldEdges(filter->GetOutput()), 0);
    // The whole image, up to where the field falls to the background beyond the last voxels.
    EXPECT_GT(FieldOf(filter->GetOutput(), "Volume"), 0.97 * std::pow(39.0, 3));
    EXPECT_LT(FieldOf(filter->GetOutput(), "Volume"), std::pow(41.0, 3));
  }
}

TEST(DeformableSurfaceStart, AcceptsLevelsWithAnAxisOfOneVoxel)
{
  // The third axis is down to one voxel, and stays so, while the others still shrink.
  const auto image = BallImage(70, 60, 12, 0.4);
  const auto pyramid =
    Updated<vtkImagePyramid>(image, [](vtkImagePyramid* p) { p->SetMinimumLevelSize(1); });
  ASSERT_GE(pyramid->GetOutput()->GetNumberOfBlocks(), 8u);
  const int* size = Level(pyramid->GetOutput(), 6)->GetDimensions();
  ASSERT_EQ(size[2], 1);
  ASSERT_GT(size[0], 1);
  const auto filter = FilterOf(pyramid->GetOutput());
  EXPECT_EQ(MessagesOfUpdate(filter), "");
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 50);
  EXPECT_FALSE(filter->GetLevels()->GetBlock(1)) << "too small for a surface: 6 voxels";
}

TEST(MissingBoundary, IsTheFractionOfThinParts)
{
  const auto filter = FilterOf(BallAndSheets(2));
  const std::string warnings = MessagesOfUpdate(filter, vtkCommand::WarningEvent);
  vtkPolyData* surface = filter->GetOutput();
  ASSERT_EQ(FieldOf(surface, "NumberOfComponents"), 1) << "the ball alone";
  EXPECT_EQ(FieldOf(surface, "LostParts"), 2);
  EXPECT_EQ(FieldOf(surface, "MissingParts"), 2);
  // Faces of voxels count as two thirds of their area, which is right for all directions in the
  // mean.
  const double sheets = 2 * (2 * 44 * 44 + 4 * 44) / 1.5;
  const double expected = sheets / (sheets + FieldOf(surface, "Area"));
  EXPECT_NEAR(FieldOf(surface, "MissingBoundary"), expected, 1e-3);
  EXPECT_EQ(CountOf(warnings, "of the object's boundary at level 0 is not on the surface"), 1)
    << warnings;
  EXPECT_EQ(CountOf(warnings, "Warning: In "), 1) << "once for the whole run: " << warnings;
  EXPECT_TRUE(Has(warnings, "all of 2 parts missed by coarser levels"));
  EXPECT_TRUE(Has(warnings, "Set Finest Level to -1"));
}

TEST(MissingBoundary, IsSmallerAtTheRecommendedLevel)
{
  const auto filter = FilterOf(BallAndSheets(1));
  EXPECT_NE(MessagesOfUpdate(filter, vtkCommand::WarningEvent), "");
  const double before = FieldOf(filter->GetOutput(), "MissingBoundary");
  ASSERT_GT(before, 0.01);
  filter->SetFinestLevel(-1);
  EXPECT_EQ(MessagesOfUpdate(filter, vtkCommand::WarningEvent), "");
  EXPECT_LT(FieldOf(filter->GetOutput(), "MissingBoundary"), 0.5 * before);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 2);
}

TEST(MissingBoundary, HasNoWarningWithAPreviewOrASelection)
{
  const std::pair<Choice, double> cases[] = {
    { [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::NoRecovery); }, 0.01 },
    { [](vtkDeformableSurface* f) { f->SetKeepComponentsToLargestComponent(); }, 0.05 },
    { [](vtkDeformableSurface* f) { f->PreviewOn(); }, 0.01 },
    { [](vtkDeformableSurface* f) { f->SetMinimumPartSize(44 * 44 + 1); }, -1.0 }
  };
  for (const auto& [choose, least] : cases)
  {
    const auto filter = FilterOf(BallAndSheets(2), choose);
    EXPECT_EQ(MessagesOfUpdate(filter, vtkCommand::WarningEvent), "");
    EXPECT_GT(FieldOf(filter->GetOutput(), "MissingBoundary"), least);
    EXPECT_EQ(FieldOf(filter->GetOutput(), "LostParts") == 0.0, least < 0.0)
      << "too small to count";
  }
}
