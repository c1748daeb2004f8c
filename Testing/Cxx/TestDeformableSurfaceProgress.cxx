// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkTable.h>

using namespace volumic;

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
    vtkPolyData* surface = filter->GetOutput();
    EXPECT_EQ(FieldOf(surface, "Level"), test.Level);
    ASSERT_GT(surface->GetNumberOfPoints(), 0);
    EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
    EXPECT_GT(EnclosedVolume(surface), 0.0);
    vtkPolyData* block = SurfaceAt(filter, test.Level);
    ASSERT_TRUE(block);
    EXPECT_EQ(block->GetNumberOfPoints(), surface->GetNumberOfPoints());
    const bool isBetween = std::string(test.Part).find("is done") != std::string::npos;
    EXPECT_EQ(StopReason(block), isBetween ? "converged" : "cancelled");
    for (int level = 0; level < test.Level; ++level)
    {
      EXPECT_FALSE(filter->GetLevels()->GetBlock(level));
    }
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
