// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Progress, and runs that are cancelled or reach their time limit.
#include "SurfaceTestTools.h"

#include <vtkTable.h>

#include <chrono>
#include <thread>

using namespace volumic;

namespace
{
vtkSmartPointer<vtkDeformableSurface> Cancelled(const std::string& part, int n)
{
  const auto filter = FilterOf(BallImage(40, 40, 40));
  const StopAtText stop(filter, part, n);
  EXPECT_EQ(MessagesOfUpdate(filter), "");
  EXPECT_LE(stop.Left, 0) << "heard nothing of " << part;
  EXPECT_LE(stop.After, 1) << "it stops at once, or as soon as the pyramid asks";
  EXPECT_EQ(StopReason(filter->GetOutput()), "cancelled");
  return filter;
}

/** Run a filter whose time limit is exceeded at that text. Allow more time on slow machines. */
void RunOutOfTime(vtkDeformableSurface* filter, const std::string& part, int number)
{
  for (double limit = 0.4; limit < 100.0; limit *= 2)
  {
    int left = number;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit + 0.01);
    const ProgressHook hook(filter,
      [&](vtkAlgorithm*, const std::string& text, double)
      {
        if (text.find(part) != std::string::npos && --left == 0)
        {
          std::this_thread::sleep_until(end);
        }
      });
    filter->ForgetRun();
    filter->SetTimeLimit(limit);
    filter->Update();
    if (left <= 0)
    {
      return;
    }
  }
  ADD_FAILURE() << "heard nothing of " << part;
}
}

TEST(DeformableSurfaceProgress, GrowsAndNamesLevelAndIteration)
{
  const auto filter = FilterOf(BallImage(40, 40, 40));
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  EXPECT_GE(listener.Shares.front(), 0.0);
  EXPECT_EQ(listener.Shares.back(), 1.0);
  EXPECT_GT(listener.Texts.size(), 10u);
  const auto has = [&](const std::string& start)
  {
    return std::any_of(listener.Texts.begin(), listener.Texts.end(),
      [&](const std::string& text) { return text.compare(0, start.size(), start) == 0; });
  };
  EXPECT_TRUE(has("Level 2, iteration 5, "));
  EXPECT_TRUE(has("Level 0, iteration "));
}

TEST(DeformableSurfaceProgress, CancellingGivesAValidSurface)
{
  const auto whole = SurfaceOf(BallImage(40, 40, 40));
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< of the surface handed over
  };
  for (const Case& test : { Case{ "Level 2, start", 1, 2 }, Case{ "Level 2, optimization", 1, 2 },
         Case{ "Level 2, optimization", 4, 2 }, Case{ "Level 2 is done", 1, 2 },
         Case{ "Level 1, subdivision", 1, 1 }, Case{ "Level 1 is done", 1, 1 },
         Case{ "Level 0, subdivision", 1, 0 }, Case{ "Level 0, recovery", 2, 0 },
         Case{ "Level 0, optimization", 3, 0 } })
  {
    SCOPED_TRACE(test.Part);
    const auto filter = Cancelled(test.Part, test.Number);
    ExpectSurfaceOfLevel(filter, test.Level);
    const bool isBetween = std::string(test.Part).find("is done") != std::string::npos;
    EXPECT_EQ(StopReason(SurfaceAt(filter, test.Level)), isBetween ? "converged" : "cancelled");
    // The request is reset.
    EXPECT_FALSE(filter->GetAbortExecute());
    filter->Modified();
    filter->Update();
    EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), whole->GetOutput()));
  }
}

TEST(DeformableSurfaceProgress, CancellingEarlyGivesAnEmptySurface)
{
  for (const char* part : { "Building the pyramid", "Level 2, voxels" })
  {
    SCOPED_TRACE(part);
    const auto filter = Cancelled(part, 1);
    vtkPolyData* surface = filter->GetOutput();
    EXPECT_EQ(surface->GetNumberOfPoints(), 0);
    EXPECT_EQ(FieldOf(surface, "NumberOfComponents"), 0);
    EXPECT_EQ(filter->GetHistory()->GetNumberOfRows(), 0);
    EXPECT_EQ(filter->GetHistory()->GetNumberOfColumns(), 15);
  }
}

TEST(TimeLimit, GivesAValidSurface)
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
    const auto filter = FilterOf(BallImage(40, 40, 40));
    RunOutOfTime(filter, test.Part, test.Number);
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(StopReason(filter->GetOutput()), "time limit");
    ExpectSurfaceOfLevel(filter, test.Level);
    for (int level = test.Level; level < 3; ++level)
    {
      EXPECT_EQ(StopReason(SurfaceAt(filter, level)),
        level > test.Level || test.Rests ? "converged" : "time limit");
    }
    vtkTable* history = filter->GetHistory();
    EXPECT_GE(history->GetValueByName(history->GetNumberOfRows() - 1, "Level").ToInt(), test.Level);
  }
}

TEST(TimeLimit, IsNotConverged)
{
  const auto image = BallImage(40, 40, 40);
  const auto filter = FilterOf(image);
  RunOutOfTime(filter, "Level 0, iteration", 1);
  ASSERT_EQ(StopReason(filter->GetOutput()), "time limit");
  filter->SetFinestLevel(1);
  filter->Update();
  EXPECT_EQ(StopReason(filter->GetOutput()), "converged") << "it has rested there";
  filter->SetFinestLevel(0);
  filter->SetTimeLimit(1e4); // not reached
  filter->Update();
  EXPECT_EQ(StopReason(filter->GetOutput()), "converged");
  EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), SurfaceOf(image)->GetOutput()));
}
