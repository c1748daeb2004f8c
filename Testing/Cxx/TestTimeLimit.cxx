// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkErrorCode.h>
#include <vtkTable.h>

#include <chrono>
#include <thread>

using namespace volumic;

namespace
{
constexpr double Limit = 60.0; ///< More than a run takes.

/** Lets the time pass, all of it, when the n-th progress text with a part is heard. */
struct Sleeper
{
  int Left;

  Sleeper(vtkAlgorithm* algorithm, const std::string& part, int left, double seconds)
    : Left(left)
    , Hook(algorithm,
        [this, part, seconds](vtkAlgorithm*, const std::string& text, double)
        {
          if (text.find(part) != std::string::npos && --this->Left == 0)
          {
            std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
          }
        })
  {
  }

  ProgressHook Hook;
};

class TimeLimit : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Filter->SetInputData(this->Image);
    this->Filter->SetIsoValue(50.0);
  }

  vtkSmartPointer<vtkImageData> Image = BallImage(40, 40, 40);
  vtkNew<vtkDeformableSurface> Filter;
};
}

TEST_F(TimeLimit, HandsOverAValidSurface)
{
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< of the surface handed over
    bool Rests;
  };
  for (const Case& test : { Case{ "Level 2, iteration", 9, 2, false },
         Case{ "Level 1, iteration", 3, 1, false }, Case{ "Level 1 is done", 1, 1, true },
         Case{ "Level 0, division", 1, 0, false }, Case{ "Level 0, regularisation", 3, 0, false } })
  {
    SCOPED_TRACE(test.Part);
    const auto filter = FilterOf(this->Image);
    filter->SetTimeLimit(1.5);
    const Sleeper sleeper(filter, test.Part, test.Number, 1.6);
    const MessagesOf errors(filter);
    const MessagesOf warnings(filter, vtkCommand::WarningEvent);
    filter->Update();
    filter->RemoveAllObservers();
    EXPECT_EQ(errors.Get() + warnings.Get(), "");
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    vtkPolyData* surface = filter->GetOutput();
    EXPECT_EQ(StopReason(surface), "time limit");
    EXPECT_EQ(FieldOf(surface, "Level"), test.Level);
    ASSERT_GT(surface->GetNumberOfPoints(), 0);
    EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
    EXPECT_GT(EnclosedVolume(surface), 0.0);
    for (int level = 0; level < 3; ++level)
    {
      auto* block = SurfaceAt(filter, level);
      ASSERT_EQ(block != nullptr, level >= test.Level);
      if (block)
      {
        EXPECT_EQ(StopReason(block),
          level > test.Level || test.Rests ? "converged" : "time limit");
      }
    }
    vtkTable* history = filter->GetHistory();
    EXPECT_GE(history->GetValueByName(history->GetNumberOfRows() - 1, "Level").ToInt(), test.Level);
  }
}

TEST_F(TimeLimit, GivesAnEmptySurfaceWhereThereIsNoneYet)
{
  for (const char* part : { "Building the pyramid", "Level 2, voxels" })
  {
    SCOPED_TRACE(part);
    this->Filter->Modified();
    this->Filter->SetTimeLimit(0.3);
    const Sleeper sleeper(this->Filter, part, 1, 0.4);
    const MessagesOf errors(this->Filter);
    this->Filter->Update();
    this->Filter->RemoveAllObservers();
    EXPECT_EQ(errors.Get(), "");
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(StopReason(this->Filter->GetOutput()), "time limit");
    EXPECT_EQ(this->Filter->GetHistory()->GetNumberOfRows(), 0);
    EXPECT_EQ(this->Filter->GetHistory()->GetNumberOfColumns(), 27);
  }
}

TEST_F(TimeLimit, ChangesNothingWhereItIsNotReached)
{
  this->Filter->SetTimeLimit(Limit);
  this->Filter->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), SurfaceOf(this->Image)->GetOutput()));
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged");
}

TEST_F(TimeLimit, IsNotTakenAsFinished)
{
  this->Filter->SetTimeLimit(1.5);
  {
    const Sleeper sleeper(this->Filter, "Level 0, iteration", 3, 1.6);
    this->Filter->Update();
    this->Filter->RemoveAllObservers();
  }
  ASSERT_EQ(StopReason(this->Filter->GetOutput()), "time limit");
  this->Filter->SetFinestLevel(1);
  this->Filter->Update();
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged") << "it has rested there";
  this->Filter->SetFinestLevel(0);
  this->Filter->SetTimeLimit(0.0);
  this->Filter->Update();
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged");
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), SurfaceOf(this->Image)->GetOutput()));
}

TEST_F(TimeLimit, IsRefusedWhereItIsNoTime)
{
  for (const double seconds : { -1.0, std::numeric_limits<double>::quiet_NaN() })
  {
    const MessagesOf errors(this->Filter);
    this->Filter->SetTimeLimit(seconds);
    this->Filter->Update();
    EXPECT_TRUE(errors.Has("Time Limit is ")) << errors.Get();
    EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::UserError);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  }
}
