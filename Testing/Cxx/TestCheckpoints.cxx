// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "TemporaryFolder.h"
#include "vtkVolumeToSurface.h"

#include <vtkSphereSource.h>

#include <fstream>

using namespace volumic;

namespace
{
/** A ball, and a rod that coarse levels do not show. */
vtkSmartPointer<vtkImageData> Scene(int size = 44)
{
  const auto image = BallImage(size, size, size, 0.3);
  ForBox({ 4, 4, 5 }, { 7, 7, size - 5 },
    [&](int i, int j, int k) { Voxels(image)->SetComponent((k * size + j) * size + i, 0, 100.0); });
  return image;
}

/** Stops a filter once its progress tells of something. */
class StopWhere
{
public:
  StopWhere(vtkAlgorithm* algorithm, const std::string& where)
    : Hook(algorithm,
        [this, where](vtkAlgorithm* filter, const std::string& text, double)
        {
          if (text.find(where) != std::string::npos)
          {
            filter->SetAbortExecute(1);
            this->HasStopped = true;
          }
        })
  {
  }

  bool HasStopped = false;

private:
  ProgressHook Hook;
};

using Choice = std::function<void(vtkDeformableSurface*)>;

class Checkpoints : public ::testing::Test
{
public:
  /** Another process would have one of its own, too. */
  vtkSmartPointer<vtkVolumeToSurface> NewFilter(const Choice& choose = {}) const
  {
    auto filter = vtkSmartPointer<vtkVolumeToSurface>::New();
    filter->SetInputData(this->Image);
    filter->SetIsoValue(50.0);
    filter->SetScratchDirectory(this->Folder.Path().c_str());
    if (choose)
    {
      choose(filter);
    }
    return filter;
  }

  /** Leaves a checkpoint of a run that was stopped. */
  void StopARun(const Choice& choose = {}, const std::string& where = "Level 0, iteration 5") const
  {
    const auto filter = this->NewFilter(choose);
    const StopWhere stop(filter, where);
    filter->Update();
    ASSERT_TRUE(stop.HasStopped);
  }

  vtkSmartPointer<vtkVolumeToSurface> Resume(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    filter->ResumeOn();
    filter->Update();
    return filter;
  }

  /** As it is without any checkpoint. */
  vtkSmartPointer<vtkVolumeToSurface> Uninterrupted(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    filter->SetScratchDirectory("");
    filter->Update();
    return filter;
  }

  /** The error of a run that is to go on, which has no surface. */
  std::string ErrorOfResuming(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    const MessagesOf errors(filter);
    filter->ResumeOn();
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    return errors.Get();
  }

  /** That of the only checkpoint there is. */
  std::string CheckpointFolder() const
  {
    const std::set<std::string> names = this->Folder.Names();
    EXPECT_EQ(names.size(), 1u);
    return names.empty() ? "" : this->Folder.File(*names.begin());
  }

  TemporaryFolder Folder;
  vtkSmartPointer<vtkImageData> Image = Scene();
};
}

TEST_F(Checkpoints, AreGoneWhenTheRunIsOver)
{
  const auto filter = this->NewFilter();
  filter->Update();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  EXPECT_EQ(filter->GetCheckpointFolder(), "");
  ExpectSameOutputs(filter, this->Uninterrupted());
}

TEST_F(Checkpoints, ArePartOfNoRunWithoutAScratchDirectory)
{
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetInputData(this->Image);
  filter->SetIsoValue(50.0);
  filter->LeaveCheckpoints();
  filter->Update();
  EXPECT_EQ(filter->GetCheckpointFolder(), "");
}

TEST_F(Checkpoints, GiveTheBitsOfARunThatWasNeverStopped)
{
  const Choice choices[] = { [](vtkDeformableSurface*) {},
    [](vtkDeformableSurface* filter)
    {
      filter->SetSnapshotInterval(7);
      filter->SetProfile(true);
    },
    [](vtkDeformableSurface* filter) { filter->SetRecovery(vtkDeformableSurface::NoRecovery); },
    [](vtkDeformableSurface* filter) { filter->SetInitializationToSeeds(); },
    [](vtkDeformableSurface* filter) { filter->SetKeepComponentsToLargestComponent(); },
    [](vtkDeformableSurface* filter) { filter->SetMaximumNumberOfIterations(12); },
    [](vtkDeformableSurface* filter) { filter->SetMetricToVoxels(); },
    [](vtkDeformableSurface* filter) { filter->SetEdgeLength(1.6); },
    [](vtkDeformableSurface* filter) { filter->SetTolerance(0.2); } };
  int number = 0;
  for (const Choice& choose : choices)
  {
    SCOPED_TRACE(number++);
    this->StopARun(choose);
    const auto filter = this->Resume(choose);
    EXPECT_EQ(filter->GetResumedLevel(), 1);
    ExpectSameOutputs(filter, this->Uninterrupted(choose));
    EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  }
}

TEST_F(Checkpoints, AreLeftByARunThatHasGoneOn)
{
  const Choice snapshots = [](vtkDeformableSurface* filter) { filter->SetSnapshotInterval(10); };
  this->StopARun(snapshots, "Level 1, iteration 5");
  const auto again = this->NewFilter(snapshots);
  again->ResumeOn();
  {
    const StopWhere stop(again, "Level 0, iteration 5");
    again->Update();
    EXPECT_EQ(again->GetResumedLevel(), 2);
    EXPECT_EQ(StopReason(again->GetOutput()), "cancelled");
    EXPECT_EQ(again->GetCheckpointFolder(), this->CheckpointFolder());
  }
  again->RemoveAllObservers();
  again->Modified();
  again->Update(); // The same filter.
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  EXPECT_EQ(again->GetResumedLevel(), 1);
  ExpectSameOutputs(again, this->Uninterrupted(snapshots));
  this->StopARun(snapshots, "Level 1, iteration 5");
  {
    const auto third = this->NewFilter(snapshots);
    third->ResumeOn();
    const StopWhere stop(third, "Level 0, division");
    third->Update();
  }
  const auto last = this->Resume(snapshots);
  EXPECT_EQ(last->GetResumedLevel(), 1);
  ExpectSameOutputs(last, this->Uninterrupted(snapshots));
}

TEST_F(Checkpoints, ServeOtherEndsThreadsAndProfiles)
{
  const Choice others[] = { [](vtkDeformableSurface* filter) { filter->SetFinestLevel(1); },
    [](vtkDeformableSurface* filter) { filter->SetFinestLevel(-1); },
    [](vtkDeformableSurface* filter) { filter->SetNumberOfThreads(1); },
    [](vtkDeformableSurface* filter) { filter->SetProfile(true); },
    [](vtkDeformableSurface* filter) { filter->SetTimeLimit(1e6); },
    [](vtkDeformableSurface* filter) { filter->SetPreview(true); } };
  int number = 0;
  for (const Choice& choose : others)
  {
    SCOPED_TRACE(number++);
    this->StopARun();
    const auto filter = this->Resume(choose);
    EXPECT_EQ(filter->GetResumedLevel(), 1);
    ExpectSameOutputs(filter, this->Uninterrupted(choose));
    EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  }
}

TEST_F(Checkpoints, AreNoneWhereARunBeginsAnew)
{
  const auto filter = this->Resume();
  EXPECT_EQ(filter->GetResumedLevel(), -2);
  ExpectSameOutputs(filter, this->Uninterrupted());
}

TEST_F(Checkpoints, OfOtherSettingsAreRefusedByName)
{
  this->StopARun();
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(22, 22, 22);
  sphere->SetRadius(17);
  sphere->SetThetaResolution(24);
  sphere->SetPhiResolution(24);
  sphere->Update();
  const std::vector<std::pair<std::string, Choice>> changes = {
    { "Iso Value was 50 and is 50.1", [](vtkDeformableSurface* f) { f->SetIsoValue(50.1); } },
    { "Friction was 3 and is 2.5", [](vtkDeformableSurface* f) { f->SetFriction(2.5); } },
    { "not the same Recovery",
      [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::NoRecovery); } },
    { "not the same Seed Positions", [](vtkDeformableSurface* f) { f->AddSeedPosition(9, 9, 9); } },
    { "not the same Initial Surface (input port 1)",
      [&](vtkDeformableSurface* f) { f->SetInitialSurfaceData(sphere->GetOutput()); } },
    { "not the same Attracting Points (input port 2)",
      [&](vtkDeformableSurface* f)
      {
        vtkNew<vtkPolyData> points;
        points->SetPoints(sphere->GetOutput()->GetPoints());
        f->SetAttractingPointsData(points);
        f->SetPointAttractionWeight(0.0);
      } },
    { "Snapshot Interval was 0 and is 9",
      [](vtkDeformableSurface* f) { f->SetSnapshotInterval(9); } },
    { "Coarsest Level was 2 and is 1", [](vtkDeformableSurface* f) { f->SetCoarsestLevel(1); } },
    { "not the same levels of the pyramid",
      [](vtkDeformableSurface* f)
      { vtkVolumeToSurface::SafeDownCast(f)->SetReductionFactor(1.6); } }
  };
  for (const auto& [what, choose] : changes)
  {
    const std::string error = this->ErrorOfResuming(choose);
    EXPECT_NE(error.find("Resume: the checkpoint " + this->CheckpointFolder() +
                " is of other settings: "),
      std::string::npos)
      << error;
    EXPECT_NE(error.find(what), std::string::npos) << what << ": " << error;
    EXPECT_NE(error.find("switch Resume off"), std::string::npos) << error;
  }
  EXPECT_EQ(this->Resume()->GetResumedLevel(), 1) << "it is still there";
}

TEST_F(Checkpoints, TellOfTheNearestOne)
{
  this->StopARun([](vtkDeformableSurface* f)
    {
      f->SetIsoValue(40.0);
      f->SetFriction(4.0);
    });
  this->StopARun([](vtkDeformableSurface* f) { f->SetIsoValue(45.0); });
  EXPECT_EQ(this->Folder.Names().size(), 2u) << "each has a folder of its own";
  const std::string error = this->ErrorOfResuming();
  EXPECT_NE(error.find("is of other settings: Iso Value was 45 and is 50."), std::string::npos)
    << error;
  EXPECT_EQ(this->Resume([](vtkDeformableSurface* f) { f->SetIsoValue(45.0); })->GetResumedLevel(),
    1);
}

TEST_F(Checkpoints, OfAnotherVolumeAreRefused)
{
  this->StopARun();
  Voxels(this->Image)->SetComponent(4711, 0, 1.5);
  this->Image->Modified();
  EXPECT_NE(this->ErrorOfResuming().find("is of another volume: not the same voxels"),
    std::string::npos)
    << this->ErrorOfResuming();
  this->Image = Scene();
  this->Image->SetSpacing(1, 1, 2);
  EXPECT_NE(this->ErrorOfResuming().find("not the same place of the volume"), std::string::npos)
    << this->ErrorOfResuming();
  this->Image = Scene(45);
  EXPECT_NE(this->ErrorOfResuming().find("not the same size of the volume"), std::string::npos);
  this->Image = Scene();
  EXPECT_EQ(this->Resume()->GetResumedLevel(), 1);
}

TEST_F(Checkpoints, OfAnotherPyramidAreRefused)
{
  const auto run = [this](vtkDataObject* pyramid, bool stops)
  {
    auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
    filter->SetInputDataObject(pyramid);
    filter->SetIsoValue(50.0);
    filter->SetScratchDirectory(this->Folder.Path().c_str());
    filter->SetResume(!stops);
    const StopWhere stop(filter, stops ? "Level 0, iteration 5" : "never");
    const MessagesOf errors(filter);
    filter->Update();
    return errors.Get();
  };
  const auto pyramid = PyramidOf(this->Image);
  run(pyramid->GetOutput(), true);
  vtkNew<vtkMultiBlockDataSet> other;
  other->DeepCopy(pyramid->GetOutput());
  Voxels(Level(other, 2))->SetComponent(99, 0, 7.0);
  const std::string error = run(other, false);
  EXPECT_NE(error.find("not the same levels of the pyramid"), std::string::npos) << error;
  EXPECT_EQ(run(pyramid->GetOutput(), false), "");
}

TEST_F(Checkpoints, AreRefusedWhereTheyAreDamaged)
{
  for (const char* name : { "state", "level-2", "level-1" })
  {
    this->StopARun();
    const std::string file = this->CheckpointFolder() + "/" + name;
    const auto size = std::filesystem::file_size(file);
    std::filesystem::resize_file(file, size / 2);
    const std::string error = this->ErrorOfResuming();
    EXPECT_NE(error.find(file + " is damaged"), std::string::npos) << error;
    std::filesystem::remove(file);
    if (std::string(name) != "state")
    {
      EXPECT_NE(this->ErrorOfResuming().find(file + " cannot be read"), std::string::npos);
    }
    const auto anew = this->NewFilter();
    anew->Update(); // Replaces it.
    ExpectSameOutputs(anew, this->Uninterrupted());
    EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  }
}

TEST_F(Checkpoints, AreNotSharedByTwoRuns)
{
  const auto first = this->NewFilter();
  vtkNew<vtkCallbackCommand> meanwhile;
  struct Meanwhile
  {
    const Checkpoints* Test;
    int Runs = 0;
  } state{ this };
  meanwhile->SetClientData(&state);
  meanwhile->SetCallback(
    [](vtkObject* caller, unsigned long, void* client, void*)
    {
      auto* state = static_cast<Meanwhile*>(client);
      auto* filter = static_cast<vtkDeformableSurface*>(caller);
      const std::string text = filter->GetProgressText() ? filter->GetProgressText() : "";
      if (text.find("Level 0, iteration 5,") == std::string::npos || state->Runs > 0)
      {
        return;
      }
      ++state->Runs;
      const std::string error = state->Test->ErrorOfResuming();
      EXPECT_NE(error.find("another run is at the checkpoint"), std::string::npos) << error;
      const auto second = state->Test->NewFilter();
      const MessagesOf warnings(second, vtkCommand::WarningEvent);
      second->Update();
      EXPECT_TRUE(warnings.Has("Another run of the same volume and settings")) << warnings.Get();
      ExpectSameOutputs(second, state->Test->Uninterrupted());
      filter->SetAbortExecute(1);
    });
  first->AddObserver(vtkCommand::ProgressEvent, meanwhile);
  first->Update();
  ASSERT_EQ(state.Runs, 1);
  EXPECT_EQ(this->Folder.Names().size(), 1u) << "that of the first is untouched";
  EXPECT_NE(this->ErrorOfResuming().find("another run is at"), std::string::npos)
    << "the filter could go on itself";
  first->ForgetRun();
  first->RemoveCheckpoint();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
}

TEST_F(Checkpoints, OfARunThatHadComeFurtherStay)
{
  this->StopARun();
  this->StopARun({}, "Level 1, iteration 5"); // Without Resume.
  const auto filter = this->Resume();
  EXPECT_EQ(filter->GetResumedLevel(), 1);
  ExpectSameOutputs(filter, this->Uninterrupted());
}

TEST_F(Checkpoints, StayForWhoWritesTheSurface)
{
  std::string folder;
  {
    const auto filter = this->NewFilter();
    filter->LeaveCheckpoints();
    filter->Update();
    folder = filter->GetCheckpointFolder();
    EXPECT_EQ(folder, this->CheckpointFolder());
  }
  const auto filter = this->NewFilter();
  filter->LeaveCheckpoints();
  filter->ResumeOn();
  const ProgressListener listener(filter);
  filter->Update();
  EXPECT_EQ(filter->GetResumedLevel(), 0);
  for (const std::string& text : listener.Texts)
  {
    EXPECT_EQ(text.find("iteration"), std::string::npos) << "no level is evolved again: " << text;
  }
  ExpectSameOutputs(filter, this->Uninterrupted());
  filter->RemoveCheckpoint();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  EXPECT_EQ(filter->GetCheckpointFolder(), "");
}

TEST_F(Checkpoints, AreGivenUpWhereTheDiskIsFull)
{
  for (const int bytes : { 0, 100, 20000, 60000, 120000 })
  {
    SCOPED_TRACE(bytes);
    const auto filter = this->NewFilter();
    const MessagesOf warnings(filter, vtkCommand::WarningEvent);
    const MessagesOf errors(filter);
    filter->LeaveCheckpoints();
    {
      const LimitedFileSize limit(bytes);
      filter->Update();
    }
    EXPECT_EQ(errors.Get(), "");
    EXPECT_TRUE(warnings.Has("could not be left: " + this->Folder.Path())) << warnings.Get();
    EXPECT_TRUE(warnings.Has("File too large")) << warnings.Get();
    const std::string folder = filter->GetCheckpointFolder();
    const bool canResume = warnings.Has("can be resumed from level");
    EXPECT_EQ(canResume, !folder.empty()) << warnings.Get();
    EXPECT_EQ(this->Folder.Names().size(), canResume ? 1u : 0u) << "nothing is left for nothing";
    ExpectSameOutputs(filter, this->Uninterrupted());
    if (canResume)
    {
      filter->SetScratchDirectory("");
      filter->SetInputData(Scene(20));
      filter->Update(); // Lets go of the folder.
      EXPECT_GE(this->Resume()->GetResumedLevel(), 1);
    }
  }
}

TEST_F(Checkpoints, NeedADirectoryThatIsThere)
{
  const auto filter = this->NewFilter();
  const MessagesOf errors(filter);
  filter->SetScratchDirectory(this->Folder.File("none").c_str());
  filter->Update();
  EXPECT_TRUE(errors.Has("Scratch Directory " + this->Folder.File("none") + " cannot be used"))
    << errors.Get();
  std::ofstream(this->Folder.File("file")) << "a";
  filter->SetScratchDirectory(this->Folder.File("file").c_str());
  filter->Update();
  EXPECT_TRUE(errors.Has("cannot be used: Not a directory")) << errors.Get();
  filter->SetScratchDirectory(this->Folder.Path().c_str());
  filter->Update();
  ExpectSameOutputs(filter, this->Uninterrupted());
}

TEST_F(Checkpoints, AreLeftByPreviewsAndLevelsThatAreShown)
{
  // A step on the way is no end: what the next one begins with is kept.
  const auto filter = this->NewFilter([](vtkDeformableSurface* f) { f->SetFinestLevel(1); });
  filter->Update();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  filter->SetFinestLevel(-1);
  {
    const StopWhere stop(filter, "Level -1, iteration 5");
    filter->Update();
    ASSERT_TRUE(stop.HasStopped);
  }
  EXPECT_EQ(this->Folder.Names().size(), 1u);
  filter->ForgetRun();
  const Choice finer = [](vtkDeformableSurface* f) { f->SetFinestLevel(-1); };
  filter->SetScratchDirectory("");
  filter->Update();
  const auto resumed = this->Resume(finer);
  EXPECT_EQ(resumed->GetResumedLevel(), 0);
  ExpectSameOutputs(resumed, this->Uninterrupted(finer));
}

TEST_F(Checkpoints, KeepTheSecondsOfTheLevelsThatWereTakenOver)
{
  std::vector<double> before;
  {
    const auto filter = this->NewFilter();
    const StopWhere stop(filter, "Level 0, iteration 5");
    filter->Update();
    vtkTable* history = filter->GetHistory();
    for (vtkIdType r = 0; r < history->GetNumberOfRows(); ++r)
    {
      if (history->GetValueByName(r, "Level").ToDouble() > 0)
      {
        before.push_back(history->GetValueByName(r, "Seconds").ToDouble());
      }
    }
  }
  const auto filter = this->Resume();
  ASSERT_GT(filter->GetHistory()->GetNumberOfRows(), static_cast<vtkIdType>(before.size()));
  for (std::size_t r = 0; r < before.size(); ++r)
  {
    const auto row = static_cast<vtkIdType>(r);
    EXPECT_EQ(filter->GetHistory()->GetValueByName(row, "Seconds").ToDouble(), before[r]);
  }
}
