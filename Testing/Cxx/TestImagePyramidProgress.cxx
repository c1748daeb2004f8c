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

class ImagePyramidProgress : public ::testing::Test
{
protected:
  /** Stops a run at a share of the work, if it is less than 1. */
  void Run(double stopAt)
  {
    this->Listener.StopAt = stopAt;
    this->Filter->SetInputData(LargeImage());
    this->Filter->SetNumberOfLevels(3);
    this->Filter->Update();
  }

  vtkNew<vtkImagePyramid> Filter;
  ProgressListener Listener{ this->Filter };
};
}

TEST_F(ImagePyramidProgress, GrowsWithinALevelAndNamesIt)
{
  this->Run(2.0);
  EXPECT_TRUE(std::is_sorted(this->Listener.Shares.begin(), this->Listener.Shares.end()));
  const auto inside = [](double share) { return share > 0.01 && share < 0.5; };
  EXPECT_TRUE(std::any_of(this->Listener.Shares.begin(), this->Listener.Shares.end(), inside));
  EXPECT_EQ(this->Listener.Shares.back(), 1.0);
  EXPECT_TRUE(this->Listener.Texts.count("Level 1 of 2"));
  EXPECT_TRUE(this->Listener.Texts.count("Level 2 of 2"));
}

TEST_F(ImagePyramidProgress, CancellingWithinALevelHandsOverTheLevelsBefore)
{
  this->Run(0.2); // within level 1
  ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 1u);
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
}

TEST_F(ImagePyramidProgress, CancellingBetweenLevelsKeepsTheFinishedOnes)
{
  this->Run(0.83); // level 1 is 0.84 of the work
  ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
  auto* level1 = vtkImageData::SafeDownCast(this->Filter->GetOutput()->GetBlock(1));
  const double* range = level1->GetPointData()->GetScalars()->GetRange();
  EXPECT_NEAR(range[0], 1.0, 1e-6) << "what is handed over is finished";
  EXPECT_NEAR(range[1], 1.0, 1e-6);
}
