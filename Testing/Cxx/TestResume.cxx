// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
/** A ball, a thin rod and a bubble: a part is missed, recovered and merged. */
vtkSmartPointer<vtkImageData> ResumeScene(int size = 64)
{
  const auto image = BallImage(size, size, size, 0.3);
  FillBox(image, { 5, 5, 6 }, { 8, 8, size - 6 });
  return image;
}

/** Return the filter after a new run. */
vtkSmartPointer<vtkDeformableSurface> FromTheStart(
  vtkDataObject* input, int finest, const Choice& choose = {})
{
  const auto filter = FilterOf(input, choose);
  filter->SetFinestLevel(finest);
  filter->Update();
  return filter;
}

/** Update. @return whether levels coarser than `level` have iterated, or the pyramid was computed
 */
bool Reruns(vtkAlgorithm* filter, int level)
{
  ProgressListener listener(filter);
  filter->Update();
  filter->RemoveAllObservers();
  return std::any_of(listener.Texts.begin(), listener.Texts.end(),
    [level](const std::string& text)
    {
      bool isRerun = bool(Has(text, "Building the pyramid"));
      for (int coarse = level + 1; coarse < 9; ++coarse)
      {
        isRerun = isRerun || Has(text, "Level " + std::to_string(coarse) + ", iteration");
      }
      return isRerun;
    });
}

/**
 * Update. @return whether no level iterates. The progress text of the last run remains.
 */
bool ShowsAtOnce(vtkAlgorithm* filter)
{
  ProgressListener listener(filter);
  filter->Update();
  filter->RemoveAllObservers();
  return listener.Texts.size() <= 1;
}

class Resume : public ::testing::Test
{
protected:
  const vtkSmartPointer<vtkImageData> Image = ResumeScene();
  const vtkSmartPointer<vtkDeformableSurface> Filter = FilterOf(this->Image);
};
}

TEST_F(Resume, IsBitIdenticalToANewRun)
{
  std::vector<Choice> choices = ChoicesOfRuns();
  choices.push_back([](vtkDeformableSurface* filter)
    { filter->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities); });
  int number = 0;
  for (const Choice& choose : choices)
  {
    SCOPED_TRACE(number++);
    const auto filter = FromTheStart(this->Image, 2, choose);
    for (const int finest : { 1, 0 })
    {
      filter->SetFinestLevel(finest);
      EXPECT_FALSE(Reruns(filter, finest)) << "resumes from level " << finest + 1;
      ExpectSameOutputs(filter, FromTheStart(this->Image, finest, choose));
    }
  }
}

TEST_F(Resume, OutputsConvergedLevelsAtOnce)
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

TEST_F(Resume, SelectsComponentsWithoutARunInAWindow)
{
  const Choice choices[] = { [](vtkDeformableSurface* f)
    { f->SetKeepComponentsToLargestComponent(); },
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
    EXPECT_EQ(warnings.Has("surface of level 0 is empty: Keep Components"), i == 3);
    const Choice allSoFar = [&](vtkDeformableSurface* filter)
    { std::for_each(choices, choices + i + 1, [&](const Choice& choose) { choose(filter); }); };
    ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 0, allSoFar));
  }
  EXPECT_FALSE(this->Filter->NewLeftOutComponents()) << "there are none";
  this->Filter->SetKeepComponentsToLargestComponent();
  this->Filter->Update();
  const auto leftOut = this->Filter->NewLeftOutComponents();
  ASSERT_TRUE(leftOut);
  EXPECT_EQ(FieldOf(leftOut, "NumberOfComponents"), 1);
  EXPECT_LT(FieldOf(leftOut, "Area"), FieldOf(this->Filter->GetOutput(), "Area"));
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(ShowsAtOnce(this->Filter));
  const auto largest = FromTheStart(this->Image, 1, choices[0]);
  ExpectSameOutputs(this->Filter, largest);
  EXPECT_FALSE(largest->NewLeftOutComponents()) << "nobody watches";
}

TEST_F(Resume, ResumesAtTheLastConvergedLevelAfterAStop)
{
  const Choice choose = [](vtkDeformableSurface* filter) { filter->SetSnapshotInterval(7); };
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< that is under way
    int Finest;
    int Stops = 2;
  };
  for (const Case& test : { Case{ "Level 3 is done", 1, 2, 0, 1 },
         Case{ "Level 2, subdivision", 1, 2, 0 }, Case{ "Level 1, recovery", 1, 1, 0 },
         Case{ "Level 0, subdivision", 1, 0, 0 }, Case{ "Level 0, iteration", 2, 0, 0 },
         Case{ "Level 0, optimization", 3, 0, 0 }, Case{ "Level -1, iteration", 2, -1, -1 } })
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

TEST_F(Resume, IgnoresALateRequestToStop)
{
  {
    const StopAtText stop(this->Filter, "Level 0, iteration", 2);
    this->Filter->Update();
  }
  this->Filter->SetAbortExecute(1);
  EXPECT_TRUE(ShowsAtOnce(this->Filter));
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
}

TEST_F(Resume, PreviewEndsAtALevelWithFewVoxels)
{
  const auto large = BallImage(180, 160, 128);
  const auto filter =
    SurfaceOf<vtkVolumeToSurface>(large, [](vtkVolumeToSurface* f) { f->PreviewOn(); });
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1) << "104 x 92 x 74 voxels";
  filter->PreviewOff();
  EXPECT_FALSE(Reruns(filter, 0));
  ExpectSameOutputs(filter, FromTheStart(large, 0));
  filter->PreviewOn();
  EXPECT_TRUE(ShowsAtOnce(filter));
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1);
  filter->SetFinestLevel(2);
  EXPECT_TRUE(ShowsAtOnce(filter));
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 2) << "not finer than requested";
}

TEST_F(Resume, KeepsNoOtherComponentsWithoutAWindow)
{
  this->Filter->SetKeepComponentsToAllComponents();
  this->Filter->Modified();
  this->Filter->Update();
  this->Filter->SetKeepComponentsToLargestComponent();
  EXPECT_TRUE(Reruns(this->Filter, 1));
}

TEST_F(Resume, RestartsAfterAnyOtherChange)
{
  const std::function<void()> changes[] = { [&] { this->Filter->SetIsoValue(45.0); },
    [&] { this->Filter->SetSnapshotInterval(5); }, [&] { this->Filter->Modified(); },
    [&] { this->Filter->SetMetricToVoxels(); }, [&] { this->Filter->ForgetRun(); },
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
    [&] { this->Filter->SetInputData(ResumeScene(56)); } };
  for (const auto& change : changes)
  {
    this->Filter->SetFinestLevel(2);
    this->Filter->Update();
    change();
    this->Filter->SetFinestLevel(1);
    EXPECT_TRUE(Reruns(this->Filter, 1));
  }
}

TEST_F(Resume, RestartsIfABlockOfThePyramidChanges)
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

TEST_F(Resume, IsIndependentOfResume)
{
  this->Filter->SetFinestLevel(1);
  const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
  this->Filter->ResumeOff();
  EXPECT_EQ(warnings.Get(), "");
  this->Filter->ResumeOn();
  const std::string once = warnings.Get();
  EXPECT_TRUE(Has(once, "Resume is deprecated and has no effect"));
  this->Filter->ResumeOn();
  this->Filter->Update();
  EXPECT_EQ(warnings.Get(), once);
  ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 1));
}

TEST_F(Resume, KeepsNothingAfterAnError)
{
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Filter->SetFinestLevel(77);
  ExpectErrorOf(this->Filter, { "Finest Level is 77" });
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(Reruns(this->Filter, 1));
  ExpectSameOutputs(this->Filter, FromTheStart(this->Image, 1));
}

TEST_F(Resume, KeepsNothingIfDataAreReleased)
{
  this->Filter->ReleaseDataFlagOn();
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Filter->SetFinestLevel(1);
  EXPECT_TRUE(Reruns(this->Filter, 1));
}

TEST_F(Resume, StartsAtAReleasedLevel)
{
  // With a thicker rod a run to level 2 starts there, and other runs start at level 1.
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

TEST_F(Resume, RestartsAfterACancelledRun)
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
