// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
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

/** Update, and return the warnings. */
std::string WarningsOf(vtkDeformableSurface* filter, vtkImageData* image)
{
  filter->SetInputData(image);
  filter->SetIsoValue(50.0);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  return warnings.Get();
}
}

TEST(MissingBoundary, Is0ForACompleteSurface)
{
  vtkNew<vtkDeformableSurface> filter;
  EXPECT_EQ(WarningsOf(filter, BallAndSheets(0)), "");
  EXPECT_EQ(FieldOf(filter->GetOutput(), "MissingBoundary"), 0.0);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "MissingParts"), 0.0);
}

TEST(MissingBoundary, IsTheFractionOfThinParts)
{
  vtkNew<vtkDeformableSurface> filter;
  const std::string warnings = WarningsOf(filter, BallAndSheets(2));
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
  vtkNew<vtkDeformableSurface> filter;
  WarningsOf(filter, BallAndSheets(1));
  const double before = FieldOf(filter->GetOutput(), "MissingBoundary");
  ASSERT_GT(before, 0.01);
  filter->SetFinestLevel(-1);
  EXPECT_EQ(WarningsOf(filter, BallAndSheets(1)), "");
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
    vtkNew<vtkDeformableSurface> filter;
    choose(filter);
    EXPECT_EQ(WarningsOf(filter, BallAndSheets(2)), "");
    EXPECT_GT(FieldOf(filter->GetOutput(), "MissingBoundary"), least);
    EXPECT_EQ(FieldOf(filter->GetOutput(), "LostParts") == 0.0, least < 0.0)
      << "too small to count";
  }
}
