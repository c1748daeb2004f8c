// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"

#include <vtkStringArray.h>

using namespace volumic;

namespace
{
std::string StopReason(vtkMultiBlockDataSet* pyramid)
{
  auto* reason =
    vtkStringArray::SafeDownCast(pyramid->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}

vtkSmartPointer<vtkImageData> LargeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(256, 256, 256);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  image->GetPointData()->GetScalars()->FillComponent(0, 1);
  return image;
}
}

TEST(ImagePyramidProgress, GrowsWithinALevelAndNamesIt)
{
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(LargeImage());
  filter->SetNumberOfLevels(3);
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  const auto inside = [](double share) { return share > 0.01 && share < 0.5; };
  EXPECT_TRUE(std::any_of(listener.Shares.begin(), listener.Shares.end(), inside));
  EXPECT_EQ(listener.Shares.back(), 1.0);
  EXPECT_TRUE(listener.Texts.count("Level 1 of 2"));
  EXPECT_TRUE(listener.Texts.count("Level 2 of 2"));
}

TEST(ImagePyramidProgress, CancellingWithinALevelHandsOverTheLevelsBefore)
{
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(LargeImage());
  filter->SetNumberOfLevels(3);
  ProgressListener listener(filter);
  listener.StopAt = 0.2; // within level 1
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 1u);
  EXPECT_EQ(StopReason(filter->GetOutput()), "cancelled");
}

TEST(ImagePyramidProgress, CancellingBetweenLevelsKeepsTheFinishedOnes)
{
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(LargeImage());
  filter->SetNumberOfLevels(3);
  ProgressListener listener(filter);
  listener.StopAt = 0.83; // level 1 is 0.84 of the work
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(StopReason(filter->GetOutput()), "cancelled");
  auto* level1 = vtkImageData::SafeDownCast(filter->GetOutput()->GetBlock(1));
  const double* range = level1->GetPointData()->GetScalars()->GetRange();
  EXPECT_NEAR(range[0], 1.0, 1e-6) << "what is handed over is finished";
  EXPECT_NEAR(range[1], 1.0, 1e-6);
}

TEST(ImagePyramidProgress, RunsToTheEndAfterACancelledRun)
{
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(LargeImage());
  filter->SetNumberOfLevels(3);
  ProgressListener listener(filter);
  listener.StopAt = 0.0;
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 1u);
  listener.StopAt = 2.0;
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 3u);
  EXPECT_EQ(StopReason(filter->GetOutput()), "complete");
}
