// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
/** A pyramid whose allocated levels are counted during a run. */
class ReleasedLevels : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Pyramid->SetInputData(BallImage(64, 60, 56, 0.3));
    this->Pyramid->SetNumberOfLevels(4);
    this->Pyramid->Update();
    for (unsigned int h = 0; h < 4; ++h)
    {
      this->Levels.emplace_back(Voxels(Level(this->Pyramid->GetOutput(), h)));
    }
    this->Filter->SetInputConnection(this->Pyramid->GetOutputPort());
    this->Filter->SetIsoValue(50.0);
  }

  int NumberHeld() const
  {
    return static_cast<int>(std::count_if(this->Levels.begin(), this->Levels.end(),
      [](const vtkWeakPointer<vtkDataArray>& voxels) { return voxels != nullptr; }));
  }

  vtkNew<vtkImagePyramid> Pyramid;
  vtkNew<vtkDeformableSurface> Filter;
  ProgressHook Hook{ this->Filter,
    [this](vtkAlgorithm*, const std::string& text, double)
    {
      for (std::size_t level = 0; level < 4; ++level)
      {
        if (text.find("Level " + std::to_string(level) + ", iteration") != std::string::npos)
        {
          this->Held[level] = std::max(this->Held[level], this->NumberHeld());
        }
      }
    } };
  std::vector<vtkWeakPointer<vtkDataArray>> Levels; ///< their voxels
  /** Maximum number of levels with voxels while the surface iterates on each level. */
  std::vector<int> Held = std::vector<int>(4, 0);
};
}

TEST_F(ReleasedLevels, AreReleasedOneByOne)
{
  this->Pyramid->ReleaseDataFlagOn();
  this->Filter->Update();
  EXPECT_EQ(this->Held, (std::vector<int>{ 1, 2, 3, 4 }));
  EXPECT_EQ(this->NumberHeld(), 1) << "level 0 is the image that the pyramid was given";
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged");
}

TEST_F(ReleasedLevels, StayWithTheOwnerOfThePyramid)
{
  this->Filter->Update();
  EXPECT_EQ(this->Held, (std::vector<int>{ 4, 4, 4, 4 }));
  EXPECT_EQ(this->NumberHeld(), 4);
}

TEST_F(ReleasedLevels, AreKeptWhileTheRunCanResume)
{
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Pyramid->GetOutput()->Initialize();
  EXPECT_EQ(this->NumberHeld(), 3) << "level 3 has been left";
  this->Filter->ForgetRun();
  EXPECT_EQ(this->NumberHeld(), 1);
}
