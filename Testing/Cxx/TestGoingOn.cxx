// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GoingOnTestTools.h"

using namespace volumic;

TEST_F(GoingOn, GivesTheSameBitsAsARunFromTheStart)
{
  const Choice choices[] = { [](vtkDeformableSurface*) {},
    [](vtkDeformableSurface* filter)
    {
      filter->SetSnapshotInterval(7);
      filter->SetProfile(true);
    },
    [](vtkDeformableSurface* filter) { filter->SetRecovery(vtkDeformableSurface::NoRecovery); },
    [](vtkDeformableSurface* filter)
    { filter->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities); },
    [](vtkDeformableSurface* filter) { filter->SetInitializationToSeeds(); },
    [](vtkDeformableSurface* filter) { filter->SetKeepComponentsToLargestComponent(); },
    [](vtkDeformableSurface* filter) { filter->SetMaximumNumberOfIterations(12); } };
  int number = 0;
  for (const Choice& choose : choices)
  {
    SCOPED_TRACE(number++);
    const auto filter = FromTheStart(this->Image, 2, choose);
    for (const int finest : { 1, 0 })
    {
      filter->SetFinestLevel(finest);
      EXPECT_FALSE(Reruns(filter, finest)) << "goes on from level " << finest + 1;
      ExpectSameOutputs(filter, FromTheStart(this->Image, finest, choose));
    }
  }
}

TEST_F(GoingOn, ServesAPyramidAndAnyNumberOfThreads)
{
  const auto pyramid = PyramidOf(this->Image);
  const auto filter = FromTheStart(
    pyramid->GetOutput(), 2, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(1); });
  filter->SetFinestLevel(0);
  filter->SetNumberOfThreads(2);
  EXPECT_FALSE(Reruns(filter, 1));
  ExpectSameOutputs(filter, FromTheStart(pyramid->GetOutput(), 0));
}

TEST_F(GoingOn, ShowsLevelsAtRestAtOnce)
{
  this->Filter->SetSnapshotInterval(10);
  const Choice same = [](vtkDeformableSurface* filter) { filter->SetSnapshotInterval(10); };
  this->Filter->Update();
  for (const int finest : { 2, 1, 0 })
  {
    this->Filter->SetFinestLevel(finest);
    EXPECT_TRUE(ShowsAtOnce(this->Filter)) << "no level iterates";
    ExpectSameOutputs(this->Filter, FromTheStart(this->Image, finest, same));
  }
}

TEST_F(GoingOn, ChoosesComponentsOfWhatIsThereWhereSomeoneWatches)
{
  const Choice choices[] = {
    [](vtkDeformableSurface* f) { f->SetKeepComponentsToLargestComponent(); },
    [](vtkDeformableSurface* f)
    {
      f->SetKeepComponentsToComponentsAtPoints();
      f->ClearSeedPositions();
      f->AddSeedPosition(6, 6, 30);
    },
    [](vtkDeformableSurface* f)
    {
      f->ClearSeedPositions();
      f->AddSeedPosition(32, 32, 32);
    },
    [](vtkDeformableSurface* f)
    {
      f->SetKeepComponentsToLargeComponents();
      f->SetMinimumComponentVolume(1e9);
    },
    [](vtkDeformableSurface* f) { f->SetMinimumComponentVolume(100); },
    [](vtkDeformableSurface* f) { f->SetKeepComponentsToAllComponents(); } };
  this->Filter->GetNeedsUpdate();
  this->Filter->Update();
  ASSERT_EQ(FieldOf(this->Filter->GetOutput(), "NumberOfComponents"), 2);
  for (std::size_t i = 0; i < std::size(choices); ++i)
  {
    SCOPED_TRACE(i);
    choices[i](this->Filter);
    const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
    EXPECT_TRUE(ShowsAtOnce(this->Filter)) << "no level iterates";
    EXPECT_EQ(warnings.Has("Level 0: Keep Components leaves none"), i == 3);
    const Choice allSoFar = [&](vtkDeformableSurface* filter)
    { std::for_each(choices, choices + i + 1, [&](const Choice& choose) { choose(filter); }); };
    ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 0, allSoFar));
  }
  this->Filter->SetKeepComponentsToLargestComponent();
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(ShowsAtOnce(this->Filter));
  ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 1, choices[0]));
}

TEST_F(GoingOn, GoesOnWithOtherComponents)
{
  this->Filter->GetNeedsUpdate();
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Filter->SetKeepComponentsToLargestComponent();
  this->Filter->SetFinestLevel(0);
  EXPECT_FALSE(Reruns(this->Filter, 1));
  ExpectSameOutputs(this->Filter,
    FromTheStart(
      this->Image, 0, [](vtkDeformableSurface* f) { f->SetKeepComponentsToLargestComponent(); }));
}

TEST_F(GoingOn, GoesOnFromTheLastLevelAtRestAfterAStop)
{
  const Choice choose = [](vtkDeformableSurface* filter)
  {
    filter->SetSnapshotInterval(7);
    filter->SetProfile(true);
  };
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< that is under way
    int Finest;
    int Stops = 2;
  };
  for (const Case& test : { Case{ "Level 3 is done", 1, 2, 0, 1 }, Case{ "Level 2, division", 1, 2, 0 },
         Case{ "Level 1, search for lost parts", 1, 1, 0 }, Case{ "Level 0, division", 1, 0, 0 },
         Case{ "Level 0, iteration", 2, 0, 0 }, Case{ "Level 0, regularisation", 3, 0, 0 },
         Case{ "Level -1, iteration", 2, -1, -1 } })
  {
    SCOPED_TRACE(test.Part);
    const auto filter = FilterOf(this->Image, choose);
    filter->SetFinestLevel(test.Finest);
    for (int stops = 0; stops < test.Stops; ++stops)
    {
      filter->SetProgressText(""); // The last one stays.
      const StopAtText stop(filter, test.Part, test.Number);
      filter->Update();
      ASSERT_LE(stop.Left, 0) << "heard nothing of it";
      ASSERT_EQ(StopReason(filter->GetOutput()), "cancelled");
      filter->SetAbortExecute(1); // Who presses twice.
      filter->GoOn();
    }
    EXPECT_FALSE(Reruns(filter, test.Level));
    ExpectSameOutputs(filter, FromTheStart(this->Image, test.Finest, choose));
  }
}

TEST_F(GoingOn, IsNotMadeToByALateRequestToStop)
{
  {
    const StopAtText stop(this->Filter, "Level 0, iteration", 2);
    this->Filter->Update();
  }
  this->Filter->SetAbortExecute(1);
  EXPECT_TRUE(ShowsAtOnce(this->Filter));
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
}

TEST_F(GoingOn, PreviewEndsAtALevelOfFewVoxels)
{
  const auto large = BallImage(180, 160, 128);
  const auto filter = SurfaceOf<vtkVolumeToSurface>(large,
    [](vtkVolumeToSurface* f) { f->PreviewOn(); });
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1) << "104 x 92 x 74 voxels";
  filter->PreviewOff();
  EXPECT_FALSE(Reruns(filter, 0));
  ExpectSameOutputs(filter, FromTheStart(large, 0));
  filter->PreviewOn();
  EXPECT_TRUE(ShowsAtOnce(filter));
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1);
  filter->SetFinestLevel(2);
  EXPECT_TRUE(ShowsAtOnce(filter));
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 2) << "not finer than asked for";
}
