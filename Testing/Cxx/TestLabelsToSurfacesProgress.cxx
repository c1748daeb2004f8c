// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Progress of vtkLabelsToSurfaces, and runs that are stopped.
#include "LabelImages.h"
#include "SameOutputs.h"

using namespace volumic;

TEST(LabelsToSurfaces, ReportsProgressAndCanBeCancelled)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  EXPECT_EQ(listener.Shares.back(), 1.);
  EXPECT_EQ(listener.Texts.count("Reading the labels"), 1u);
  EXPECT_EQ(listener.Texts.count("Fields of the labels"), 1u);
  EXPECT_EQ(listener.Texts.count("Interfaces of the labels"), 1u);
  listener.StopAt = 0.;
  filter->Modified();
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_EQ(warnings.Get(), "") << "unfinished labels are not lost";
  EXPECT_EQ(filter->GetErrorCode(), 0u);
}

TEST(LabelsToSurfaces, EndsAtItsTimeLimit)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  const auto whole = LabelSurfacesOf(filter->GetInputDataObject(0, 0));
  filter->SetTimeLimit(1e-9);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  for (const unsigned int block : { 0u, 1u })
  {
    EXPECT_EQ(StopReason(BlockOf(filter, block)), "time limit");
  }
  filter->SetTimeLimit(0.0);
  filter->Update();
  ExpectSameBlocks(filter->GetOutput(), whole->GetOutput());
  filter->SetTimeLimit(-1.0);
  const MessagesOf errors(filter, vtkCommand::ErrorEvent);
  filter->Update();
  EXPECT_NE(errors.Get().find("Time Limit is -1"), std::string::npos) << errors.Get();
}
