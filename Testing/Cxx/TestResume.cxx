// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Runs that resume, and levels that are output one by one.
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

/** Settings with more state to keep in a cancelled run than the defaults. */
const Choice Choices[] = { [](vtkDeformableSurface*) {},
  [](vtkDeformableSurface* f) { f->SetSnapshotInterval(7); },
  [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::NoRecovery); },
  [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities); },
  [](vtkDeformableSurface* f) { f->SetInitializationToSeeds(); },
  [](vtkDeformableSurface* f) { f->SetKeepComponentsToLargestComponent(); },
  [](vtkDeformableSurface* f) { f->SetMaximumNumberOfIterations(12); } };

/** A ball whose preview is level 1 of 2, of 104 x 92 x 74 voxels. */
vtkSmartPointer<vtkImageData> LargeBall()
{
  return BallImage(180, 160, 128);
}

/** Return the filter after a new run. */
vtkSmartPointer<vtkDeformableSurface> FromTheStart(
  vtkDataObject* input, int finest, const Choice& choose = Choices[0])
{
  const auto filter = FilterOf(input, choose);
  filter->SetFinestLevel(finest);
  filter->Update();
  return filter;
}

/** Update. @return whether levels coarser than `level` iterate, or the pyramid is computed */
bool Reruns(vtkAlgorithm* filter, int level)
{
  bool isRerun = false;
  const ProgressHook hook(filter,
    [&](vtkAlgorithm*, const std::string& text, double)
    {
      isRerun = isRerun || Has(text, "Building the pyramid") ||
        (Has(text, ", iteration") && std::stoi(text.substr(6)) > level); // behind "Level "
    });
  filter->Update();
  return isRerun;
}

/** Update. @return whether no level iterates. The progress text of the last run remains. */
bool ShowsAtOnce(vtkAlgorithm* filter)
{
  const ProgressListener listener(filter);
  filter->Update();
  return listener.Texts.size() <= 1;
}

vtkSmartPointer<vtkVolumeToSurface> ShowingFilterOf(vtkImageData* image)
{
  return FilterOf<vtkVolumeToSurface>(image, [](vtkVolumeToSurface* f) { f->ShowLevelsOn(); });
}

/** Return the levels that a caller of GetNeedsUpdate() gets, in order. */
std::vector<int> LevelsShown(vtkDeformableSurface* filter)
{
  std::vector<int> levels;
  filter->GetNeedsUpdate();
  do
  {
    filter->Update();
    levels.push_back(static_cast<int>(FieldOf(filter->GetOutput(), "Level")));
  } while (filter->GetNeedsUpdate() && levels.size() < 9);
  return levels;
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
  int number = 0;
  for (const Choice& choose : Choices)
  {
    SCOPED_TRACE(number++);
    const auto filter = FromTheStart(this->Image, 2, choose);
    for (const int finest : { 1, 0 })
    {
      filter->SetFinestLevel(finest);
      EXPECT_FALSE(Reruns(filter, finest)) << "resumes from level " << finest + 1;
      ExpectSameOutputs(filter, FromTheStart(this->Image, finest, choose));
    }
    // A converged level is output at once.
    filter->SetFinestLevel(1);
    EXPECT_TRUE(ShowsAtOnce(filter));
    ExpectSameOutputs(filter, FromTheStart(this->Image, 1, choose));
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
  struct Case
  {
    const char* Part;
    int Number;
    int Level; ///< that is under way
    int Finest, Stops = 2;
  };
  for (const Case& test : { Case{ "Level 3 is done", 1, 2, 0, 1 },
         Case{ "Level 2, subdivision", 1, 2, 0 }, Case{ "Level 1, recovery", 1, 1, 0 },
         Case{ "Level 0, subdivision", 1, 0, 0 }, Case{ "Level 0, iteration", 2, 0, 0 },
         Case{ "Level 0, optimization", 3, 0, 0 }, Case{ "Level -1, iteration", 2, -1, -1 } })
  {
    SCOPED_TRACE(test.Part);
    const auto filter = FilterOf(this->Image, Choices[1]);
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
    ExpectSameOutputs(filter, FromTheStart(this->Image, test.Finest, Choices[1]));
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
  const auto large = LargeBall();
  const auto filter =
    SurfaceOf<vtkVolumeToSurface>(large, [](vtkVolumeToSurface* f) { f->PreviewOn(); });
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1);
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
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->ShallowCopy(PyramidOf(this->Image)->GetOutput());
  const std::function<void()> changes[] = { [&] { this->Filter->SetIsoValue(45.0); },
    [&] { this->Filter->SetSnapshotInterval(5); }, [&] { this->Filter->Modified(); },
    [&] { this->Filter->SetMetricToVoxels(); }, [&] { this->Filter->ForgetRun(); },
    [&]
    {
      Voxels(this->Image)->SetComponent(5, 0, 20.0);
      Voxels(this->Image)->Modified();
    },
    [&]
    {
      Voxels(this->Image)->SetComponent(6, 0, 20.0);
      this->Image->Modified();
    },
    [&] { this->Filter->SetInputData(ResumeScene(56)); },
    [&] { this->Filter->SetInputDataObject(blocks); },
    [&]
    {
      Voxels(Level(blocks, 1))->SetComponent(5, 0, 1.0);
      Voxels(Level(blocks, 1))->Modified();
    } };
  for (const auto& change : changes)
  {
    this->Filter->SetFinestLevel(2);
    this->Filter->Update();
    change();
    this->Filter->SetFinestLevel(1);
    EXPECT_TRUE(Reruns(this->Filter, 1));
  }
}

TEST_F(Resume, IsIndependentOfDeprecatedProperties)
{
  this->Filter->SetFinestLevel(1);
  const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
  this->Filter->ResumeOff();
  EXPECT_EQ(warnings.Get(), "");
  this->Filter->ResumeOn();
  this->Filter->ResumeOn();
  EXPECT_EQ(CountOf(warnings.Get(), "Resume is deprecated and has no effect"), 1);
  this->Filter->ProfileOn();
  EXPECT_TRUE(Has(warnings.Get(), "Profile is deprecated"));
  this->Filter->Update();
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
  const auto filter = FromTheStart(this->Image, 1, Choices[2]);
  ASSERT_EQ(filter->GetHistory()->GetValueByName(0, "Level").ToInt(), 1);
  for (const int finest : { 2, 1 })
  {
    filter->SetFinestLevel(finest);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), 0u);
    EXPECT_EQ(filter->GetHistory()->GetValueByName(0, "Level").ToInt(), finest);
    ExpectSameOutputs(filter, FromTheStart(this->Image, finest, Choices[2]));
  }
}

TEST_F(Resume, RestartsAfterACancelledRun)
{
  {
    const StopAtText stop(this->Filter, "Level 1, iteration", 1);
    this->Filter->Update();
  }
  ASSERT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
  for (const int finest : { 1, 0 })
  {
    this->Filter->SetFinestLevel(finest);
    this->Filter->Update();
    ExpectSameOutputs(this->Filter, FromTheStart(this->Image, finest));
  }
}

TEST(ShowLevels, OutputsLevelsOneByOne)
{
  const auto image = LargeBall();
  const auto filter = ShowingFilterOf(image);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 }));
  const auto atOnce = ShowingFilterOf(image);
  atOnce->Update();
  EXPECT_FALSE(atOnce->GetNeedsUpdate()) << "no effect on a caller that does not ask";
  EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), atOnce->GetOutput()));
  filter->SetIsoValue(40.0);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 })) << "again";
  filter->ShowLevelsOff();
  filter->SetIsoValue(45.0);
  EXPECT_EQ(LevelsShown(filter), std::vector<int>{ 0 });
}

TEST(ShowLevels, ShowsTheLevelThatWasStopped)
{
  for (const bool isPreview : { false, true })
  {
    const auto filter = ShowingFilterOf(LargeBall());
    filter->SetPreview(isPreview);
    filter->GetNeedsUpdate();
    {
      const StopAtText stop(filter, "Level 1, iteration", 1);
      filter->Update();
      ASSERT_EQ(StopReason(filter->GetOutput()), "cancelled");
    }
    EXPECT_FALSE(filter->GetNeedsUpdate());
    filter->GoOn();
    EXPECT_EQ(LevelsShown(filter), isPreview ? std::vector<int>{ 1 } : (std::vector<int>{ 1, 0 }));
  }
}

TEST(ShowLevels, WarnsOnlyAtTheEnd)
{
  const auto image = LargeBall();
  Voxels(image)->SetComponent(0, 0, vtkMath::Nan());
  const auto filter = ShowingFilterOf(image);
  filter->SetKeepComponents(vtkDeformableSurface::LargeComponents);
  filter->SetMinimumComponentVolume(1e9);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->GetNeedsUpdate();
  filter->Update();
  EXPECT_EQ(warnings.Get(), "");
  ASSERT_TRUE(filter->GetNeedsUpdate());
  filter->Update();
  EXPECT_TRUE(warnings.Has("surface of level 0 is empty: Keep Components"));
  EXPECT_TRUE(warnings.Has("has 1 NaN voxel")) << warnings.Get();
}

TEST(ShowLevels, EndsAfterAnErrorAndAtTheTimeLimit)
{
  const auto filter = ShowingFilterOf(LargeBall());
  filter->GetNeedsUpdate();
  filter->Update();
  filter->SetIsoValue(1e5);
  ExpectErrorOf(filter, { "Iso Value is 100000" });
  EXPECT_FALSE(filter->GetNeedsUpdate());
  filter->SetIsoValue(50.0);
  filter->SetTimeLimit(1e-6);
  filter->Update();
  EXPECT_FALSE(filter->GetNeedsUpdate());
  filter->SetTimeLimit(0.0);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 }));
}
