// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkTable.h>

#include <chrono>
#include <thread>

using namespace volumic;

namespace
{
/** Waits for the time limit at the n-th progress text that contains a part. */
struct Waiter
{
  int Left;

  Waiter(vtkAlgorithm* algorithm, const std::string& part, int left, double seconds)
    : Left(left),
      Hook(algorithm,
        [this, part, seconds](vtkAlgorithm*, const std::string& text, double)
        {
          if (text.find(part) != std::string::npos && --this->Left == 0)
          {
            std::this_thread::sleep_until(this->Start + std::chrono::duration<double>(seconds));
          }
        })
  {
  }

  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  ProgressHook Hook;
};

/** Run a filter whose time limit is exceeded at that text. Allow more time on slow machines. */
void RunOutOfTime(vtkDeformableSurface* filter, const std::string& part, int number)
{
  for (double limit = 0.4; limit < 100.0; limit *= 2)
  {
    filter->ForgetRun();
    filter->SetTimeLimit(limit);
    const Waiter waiter(filter, part, number, limit + 0.01);
    filter->Update();
    filter->RemoveAllObservers();
    if (waiter.Left <= 0)
    {
      return;
    }
  }
  ADD_FAILURE() << "heard nothing of " << part;
}

class TimeLimit : public ::testing::Test
{
protected:
  const vtkSmartPointer<vtkImageData> Image = BallImage(40, 40, 40);
  const vtkSmartPointer<vtkDeformableSurface> Filter = FilterOf(this->Image);
};
}

TEST_F(TimeLimit, GivesAValidSurface)
{
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< of the surface handed over
    bool Rests;
  };
  for (const Case& test :
    { Case{ "Level 2, iteration", 9, 2, false }, Case{ "Level 1, iteration", 1, 1, false },
      Case{ "Level 1 is done", 1, 1, true }, Case{ "Level 0, subdivision", 1, 0, false },
      Case{ "Level 0, optimization", 3, 0, false } })
  {
    SCOPED_TRACE(test.Part);
    const auto filter = FilterOf(this->Image);
    RunOutOfTime(filter, test.Part, test.Number);
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
        EXPECT_EQ(StopReason(block), level > test.Level || test.Rests ? "converged" : "time limit");
      }
    }
    vtkTable* history = filter->GetHistory();
    EXPECT_GE(history->GetValueByName(history->GetNumberOfRows() - 1, "Level").ToInt(), test.Level);
  }
}

TEST_F(TimeLimit, HasNoEffectUnlessReached)
{
  this->Filter->SetTimeLimit(1e4);
  this->Filter->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), SurfaceOf(this->Image)->GetOutput()));
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged");
}

TEST_F(TimeLimit, IsNotConverged)
{
  RunOutOfTime(this->Filter, "Level 0, iteration", 1);
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

TEST_F(TimeLimit, ReportsInvalidTimes)
{
  for (const double seconds : { -1.0, std::numeric_limits<double>::quiet_NaN() })
  {
    this->Filter->SetTimeLimit(seconds);
    ExpectErrorOf(this->Filter, { "Time Limit is " });
  }
}
