// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Where a run cannot go on with what the filter holds, and where one from the start would begin.
#include "GoingOnTestTools.h"

#include <vtkTable.h>

using namespace volumic;

TEST_F(GoingOn, HoldsNoOtherComponentsWhereNobodyWatchesOrMemoryIsShort)
{
  for (const int limit : { 0, 1000 })
  {
    this->Filter->SetMemoryLimit(limit);
    this->Filter->SetKeepComponentsToAllComponents();
    this->Filter->Modified();
    this->Filter->Update();
    this->Filter->SetKeepComponentsToLargestComponent();
    EXPECT_TRUE(Reruns(this->Filter, 1));
    this->Filter->GetNeedsUpdate();
  }
}

TEST_F(GoingOn, BeginsAnewAfterAnyOtherChange)
{
  const std::function<void()> changes[] = { [&] { this->Filter->SetIsoValue(45.0); },
    [&] { this->Filter->SetSnapshotInterval(5); },
    [&] { this->Filter->Modified(); },
    [&] { this->Filter->SetMetricToVoxels(); },
    [&] { this->Filter->ForgetRun(); },
    [&]
    {
      this->Image->GetPointData()->GetScalars()->SetComponent(5, 0, 20.0);
      this->Image->GetPointData()->GetScalars()->Modified();
    },
    [&]
    {
      Voxels(this->Image)->SetComponent(6, 0, 20.0);
      this->Image->Modified();
    },
    [&] { this->Filter->SetInputData(GoingOnScene(56)); } };
  for (const auto& change : changes)
  {
    this->Filter->SetFinestLevel(2);
    this->Filter->Update();
    change();
    this->Filter->SetFinestLevel(1);
    EXPECT_TRUE(Reruns(this->Filter, 1));
  }
}

TEST_F(GoingOn, BeginsAnewWhereABlockOfThePyramidHasChanged)
{
  const auto pyramid = PyramidOf(this->Image);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->ShallowCopy(pyramid->GetOutput());
  this->Filter->SetInputDataObject(blocks);
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  vtkDataArray* voxels = Voxels(Level(blocks, 1));
  voxels->SetComponent(voxels->GetNumberOfTuples() / 2, 0, 1.0);
  voxels->Modified();
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(Reruns(this->Filter, 1));
}

TEST_F(GoingOn, KeepsNothingAfterAnError)
{
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  {
    const MessagesOf errors(this->Filter);
    this->Filter->SetFinestLevel(77);
    this->Filter->Update();
    ASSERT_TRUE(errors.Has("Finest Level is 77")) << errors.Get();
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  }
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(Reruns(this->Filter, 1));
  ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 1));
}

TEST_F(GoingOn, KeepsNothingWhereDataAreReleased)
{
  this->Filter->ReleaseDataFlagOn();
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(Reruns(this->Filter, 1));
}

TEST_F(GoingOn, BeginsAtALevelThatWasLetGo)
{
  // A thicker rod: one that is to end at level 2 begins there, others at level 1.
  FillBox(this->Image, { 0, 0, 0 }, { 64, 64, 64 }, 0.0);
  FillBox(this->Image, { 5, 5, 6 }, { 10, 10, 58 });
  const Choice choose = [](vtkDeformableSurface* filter)
  { filter->SetRecovery(vtkDeformableSurface::NoRecovery); };
  const auto filter = FromTheStart(this->Image, 1, choose);
  ASSERT_EQ(filter->GetHistory()->GetValueByName(0, "Level").ToInt(), 1);
  for (const int finest : { 2, 1 })
  {
    filter->SetFinestLevel(finest);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), 0u);
    EXPECT_EQ(filter->GetHistory()->GetValueByName(0, "Level").ToInt(), finest);
    ExpectSameOutputs(filter, FromTheStart(this->Image, finest, choose));
  }
}

TEST_F(GoingOn, BeginsAnewAfterACancelledRun)
{
  ProgressListener listener(this->Filter);
  listener.StopAt = 0.7;
  this->Filter->Update();
  ASSERT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
  this->Filter->RemoveAllObservers();
  for (const int finest : { 1, 0 })
  {
    this->Filter->SetFinestLevel(finest);
    this->Filter->Update();
    ExpectSameOutputs(this->Filter, FromTheStart(this->Image, finest));
  }
}
