// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CheckpointTestTools.h"

using namespace volumic;

TEST_F(Checkpoints, GiveTheBitsOfARunThatWasNeverStopped)
{
  std::vector<Choice> choices = ChoicesOfRuns();
  choices.emplace_back([](vtkDeformableSurface* filter) { filter->SetMetricToVoxels(); });
  choices.emplace_back([](vtkDeformableSurface* filter) { filter->SetEdgeLength(1.6); });
  choices.emplace_back([](vtkDeformableSurface* filter) { filter->SetTolerance(0.2); });
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
    const StopAtText stop(again, "Level 0, iteration 5", 1);
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
}

TEST_F(Checkpoints, ServeOtherEndsAndThreads)
{
  const Choice others[] = { [](vtkDeformableSurface* filter) { filter->SetFinestLevel(1); },
    [](vtkDeformableSurface* filter) { filter->SetFinestLevel(-1); },
    [](vtkDeformableSurface* filter) { filter->SetNumberOfThreads(1); },
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

TEST_F(Checkpoints, AreNotSharedByTwoRuns)
{
  const auto first = this->NewFilter();
  int runs = 0;
  const ProgressHook meanwhile(first,
    [&](vtkAlgorithm* filter, const std::string& text, double)
    {
      if (!Has(text, "Level 0, iteration 5,") || runs > 0)
      {
        return;
      }
      ++runs;
      EXPECT_TRUE(Has(this->ErrorOfResuming(), "another run is at the checkpoint"));
      const auto second = this->NewFilter();
      const MessagesOf warnings(second, vtkCommand::WarningEvent);
      second->Update();
      EXPECT_TRUE(warnings.Has("Another run of the same volume and settings")) << warnings.Get();
      ExpectSameOutputs(second, this->Uninterrupted());
      filter->SetAbortExecute(1);
    });
  first->Update();
  ASSERT_EQ(runs, 1);
  EXPECT_EQ(this->Folder.Names().size(), 1u) << "that of the first is untouched";
  EXPECT_TRUE(Has(this->ErrorOfResuming(), "another run is at")) << "the filter could go on itself";
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
    EXPECT_FALSE(Has(text, "iteration")) << "no level is evolved again: " << text;
  }
  ExpectSameOutputs(filter, this->Uninterrupted());
  filter->RemoveCheckpoint();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  EXPECT_EQ(filter->GetCheckpointFolder(), "");
}

TEST_F(Checkpoints, AreLeftByPreviewsAndLevelsThatAreShown)
{
  // A step on the way is no end: what the next one begins with is kept.
  const auto filter = this->NewFilter([](vtkDeformableSurface* f) { f->SetFinestLevel(1); });
  filter->Update();
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
  filter->SetFinestLevel(-1);
  {
    const StopAtText stop(filter, "Level -1, iteration 5", 1);
    filter->Update();
    ASSERT_LE(stop.Left, 0);
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
