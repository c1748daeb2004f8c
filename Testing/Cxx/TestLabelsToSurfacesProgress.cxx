// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What surfaces of labels tell while they are made, and how they go on after a stop.
#include "LabelImages.h"
#include "SurfaceTestTools.h"

#include <vtkCellData.h>

using namespace volumic;

TEST(LabelsToSurfaces, TellsWhichIsUnderWay)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  AddNames(vtkImageData::SafeDownCast(filter->GetInputDataObject(0, 0)));
  filter->SetMerge(true); // it is made on the calling thread, which tells of each iteration
  filter->SetLabelName(3, "left half");
  filter->AddLabel(3);
  ProgressListener one(filter);
  filter->Update();
  EXPECT_EQ(one.Texts.count("0 of 1, left half"), 1u);
  filter->SetMerge(false);
  filter->AddLabel(7);
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_EQ(listener.Texts.count("0 of 2"), 1u);
}

TEST(LabelsToSurfaces, GoesOnWithWhatIsMissingAfterAStop)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  filter->SetNumberOfThreads(2); // The first is so large that one comes after the other.
  const auto whole = LabelSurfacesOf(filter->GetInputDataObject(0, 0));
  const auto stopAndGoOn = [&]
  {
    {
      const StopAtText stop(filter, "1 of 2, ", 2);
      const MessagesOf warnings(filter, vtkCommand::WarningEvent);
      filter->Modified();
      filter->Update();
      EXPECT_LE(stop.Left, 0);
      EXPECT_EQ(warnings.Get(), "") << "what was not finished is not lost";
    }
    filter->SetAbortExecute(1); // Heard after the run has ended.
    ProgressListener late(filter);
    filter->Update();
    filter->RemoveAllObservers();
    EXPECT_EQ(late.Texts.count("0 of 1"), 0u);
    filter->GoOn();
    return [&]
    {
      ProgressListener listener(filter);
      filter->Update();
      for (const unsigned int block : { 0u, 1u })
      {
        EXPECT_TRUE(AreSameSurfaces(BlockOf(filter, block), BlockOf(whole, block)));
        EXPECT_GT(filter->GetSeconds(static_cast<int>(block)), 0.0);
      }
      EXPECT_EQ(listener.Texts.count("0 of 1") + listener.Texts.count("0 of 2"), 1u);
      return listener.Texts.count("0 of 2") > 0;
    };
  };
  EXPECT_FALSE(stopAndGoOn()());
  const auto afterChange = stopAndGoOn();
  whole->SetSmoothing(0.9);
  whole->Update();
  filter->SetSmoothing(0.9);
  EXPECT_TRUE(afterChange());
}

TEST(LabelsToSurfaces, EndsAtItsTimeLimit)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  const auto whole = LabelSurfacesOf(filter->GetInputDataObject(0, 0));
  for (const bool areShared : { true, false })
  {
    filter->SetSharedInterfaces(areShared);
    filter->SetTimeLimit(1e-9);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), 0u);
    ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
    for (const unsigned int block : { 0u, 1u })
    {
      EXPECT_EQ(StopReason(BlockOf(filter, block)), "time limit");
    }
  }
  filter->SetTimeLimit(0.0);
  filter->Update();
  for (const unsigned int block : { 0u, 1u })
  {
    EXPECT_TRUE(AreSameSurfaces(BlockOf(filter, block), BlockOf(whole, block)));
  }
  filter->SetTimeLimit(-1.0);
  const MessagesOf errors(filter, vtkCommand::ErrorEvent);
  filter->Update();
  EXPECT_NE(errors.Get().find("Time Limit is -1"), std::string::npos) << errors.Get();
}

TEST(LabelsToSurfaces, GoesOnWithAnotherTimeLimit)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  filter->SetNumberOfThreads(2); // As above: one after the other.
  {
    const StopAtText stop(filter, "1 of 2, ", 2);
    filter->Update();
  }
  filter->SetTimeLimit(1e6);
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_EQ(listener.Texts.count("0 of 1"), 1u) << "what is finished stays";
  EXPECT_EQ(StopReason(BlockOf(filter, 1)), "converged");
}

TEST(LabelsToSurfaces, TellsProgressAndCanBeStopped)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  filter->SetNumberOfThreads(1);
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  EXPECT_EQ(listener.Shares.back(), 1.);
  EXPECT_GT(filter->GetSeconds(0), 0.);
  EXPECT_GT(filter->GetSeconds(1), 0.);
  EXPECT_EQ(filter->GetSeconds(-1), 0.);
  EXPECT_EQ(filter->GetSeconds(2), 0.);
  const vtkIdType all = BlockOf(filter, 0)->GetNumberOfCells();

  listener.StopAt = 0.;
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  for (const unsigned int block : { 0u, 1u })
  {
    EXPECT_EQ(StopReason(BlockOf(filter, block)), "cancelled");
    EXPECT_TRUE(BlockOf(filter, block)->GetCellData()->HasArray("Label"));
  }
  listener.StopAt = 2.;
  filter->Modified();
  filter->Update();
  EXPECT_EQ(BlockOf(filter, 0)->GetNumberOfCells(), all) << "works again";
}
