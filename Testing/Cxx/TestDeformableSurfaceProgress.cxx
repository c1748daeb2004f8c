// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkFeatureEdges.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace volumic;

TEST(DeformableSurfaceProgress, GrowsAndNamesLevelAndIteration)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
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
  EXPECT_TRUE(has("Level 2, iteration 1, "));
  EXPECT_TRUE(has("Level 0, iteration "));
}

TEST(DeformableSurfaceProgress, CancellingHandsOverAValidSurface)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  ProgressListener listener(filter);
  listener.StopAt = 0.1;
  filter->Update();
  vtkPolyData* surface = filter->GetOutput();
  ASSERT_GT(surface->GetNumberOfPoints(), 0);
  EXPECT_EQ(StopReason(surface), "cancelled");
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->NonManifoldEdgesOn();
  edges->Update();
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_FALSE(filter->GetLevels()->GetBlock(0)) << "levels that were not reached are empty";
}

TEST(DeformableSurfaceProgress, RunsToTheEndAfterACancelledRun)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  ProgressListener listener(filter);
  listener.StopAt = 0.05;
  filter->Update();
  ASSERT_EQ(StopReason(filter->GetOutput()), "cancelled");
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  listener.StopAt = 2.0;
  filter->Update();
  ASSERT_EQ(StopReason(filter->GetOutput()), "cancelled") << "what follows can show or write it";
  // Nobody takes the request back, as in ParaView.
  filter->Modified();
  filter->Update();
  EXPECT_EQ(StopReason(filter->GetOutput()), "converged");
}
