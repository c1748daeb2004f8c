// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A finest level that all ranks share: no rank ever has its whole surface, and each makes its piece.
#include "RankOutputTestTools.h"
#include "TemporaryFolder.h"
#include "vtkImagePyramid.h"

#include <vtkErrorCode.h>

using namespace volumic;

namespace
{
Filter FilterOf(vtkDataObject* input, vtkMultiProcessController* controller)
{
  auto filter = Filter::New();
  filter->SetController(controller);
  filter->SetInputDataObject(input);
  filter->SetIsoValue(50.0);
  filter->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities);
  filter->SetNumberOfThreads(1);
  return filter;
}

Filter BallsFilter(vtkMultiProcessController* controller)
{
  return FilterOf(TwoBalls(), controller);
}

Filter OneRank(const std::function<void(vtkDeformableSurface*)>& set = {})
{
  Filter filter = BallsFilter(nullptr);
  if (set)
  {
    set(filter);
  }
  filter->Update();
  return filter;
}

/** All ranks show what one does. */
void ExpectAs(vtkDeformableSurface* one, const Ranks& ranks)
{
  std::vector<vtkMultiBlockDataSet*> levels;
  for (const Filter& filter : ranks)
  {
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    levels.push_back(filter->GetLevels());
  }
  ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
  ExpectBlocksOf(one->GetLevels(), levels);
}

void Update(vtkDeformableSurface* filter, vtkMultiProcessController* controller)
{
  ThreadControllers::Update(filter, controller);
}

double FactOf(vtkDeformableSurface* filter, const char* name)
{
  return filter->GetOutput()->GetFieldData()->GetArray(name)->GetTuple1(0);
}
}

TEST(RankPieces, AreOfTheSurfaceOfOneRank)
{
  const Filter one = OneRank();
  EXPECT_EQ(FactOf(one, "NumberOfComponents"), 3.0);
  for (const int count : { 1, 2, 3, 5 })
  {
    SCOPED_TRACE(count);
    const Ranks ranks = RunRanks(count, BallsFilter, Update);
    if (count == 1)
    {
      ExpectSameOutputs(one, ranks.front());
      continue;
    }
    ExpectAs(one, ranks);
    for (const Filter& filter : ranks)
    {
      EXPECT_NEAR(filter->GetOutput()->GetNumberOfCells(),
        one->GetOutput()->GetNumberOfCells() / count, 1);
    }
  }
}

TEST(RankPieces, OfAllLevelsThatRanksShare)
{
  // Where nothing is kept to go on from no rank ever has the whole of one.
  const auto make = [](vtkMultiProcessController* controller)
  {
    Filter filter = BallsFilter(controller);
    filter->SetReleaseDataFlag(1);
    return filter;
  };
  const Filter one = OneRank();
  for (const int count : { 2, 3, 5 })
  {
    SCOPED_TRACE(count);
    ExpectAs(one, RunRanks(count, make, Update));
  }
}

TEST(RankPieces, OfTheLevelThatAStopHasLeft)
{
  const auto make = [](vtkMultiProcessController* controller)
  {
    Filter filter = BallsFilter(controller);
    filter->SetReleaseDataFlag(1);
    return filter;
  };
  std::set<double> levels;
  for (const double share : { 0.3, 0.45, 0.6, 0.7, 0.8, 0.9 })
  {
    SCOPED_TRACE(share);
    const Ranks ranks = RunRanks(3, make,
      [share](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
      {
        ProgressListener stops(filter);
        stops.StopAt = controller->GetLocalProcessId() == 0 ? share : 2.0;
        ThreadControllers::Update(filter, controller);
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      });
    vtkIdType cells = 0;
    std::set<vtkIdType> points;
    for (const Filter& filter : ranks)
    {
      EXPECT_EQ(StopReasonOf(filter), "cancelled");
      EXPECT_EQ(FactOf(filter, "Level"), FactOf(ranks.front(), "Level"));
      vtkPolyData* piece = filter->GetOutput();
      cells += piece->GetNumberOfCells();
      for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
      {
        points.insert(IdOf(piece, p));
      }
    }
    levels.insert(FactOf(ranks.front(), "Level"));
    // Closed: F = 2 (V - chi).
    const auto features = FactOf(ranks.front(), "Genus");
    EXPECT_EQ(cells,
      2 * (static_cast<double>(points.size()) -
            2 * FactOf(ranks.front(), "NumberOfComponents") + 2 * features));
  }
  EXPECT_GT(levels.size(), 1u);
}

TEST(RankPieces, AreShownAgain)
{
  const auto update = [](vtkDeformableSurface* filter, vtkMultiProcessController* controller,
                        int ghosts, bool isKept)
  {
    const ProgressListener progress(filter);
    ThreadControllers::Update(filter, controller, ghosts);
    EXPECT_EQ(std::none_of(progress.Shares.begin(), progress.Shares.end(),
                [](double share) { return share > 0.0 && share < 1.0; }),
      isKept);
  };
  const Filter one = OneRank();
  const Ranks ranks = RunRanks(3, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      update(filter, controller, 0, false);
      filter->SetFinestLevel(1);
      update(filter, controller, 0, true);
      EXPECT_EQ(FactOf(filter, "Level"), 1.0);
      filter->SetFinestLevel(0);
      update(filter, controller, 0, true);
      EXPECT_EQ(FactOf(filter, "Level"), 0.0);
      const vtkIdType own = filter->GetOutput()->GetNumberOfCells();
      // With ghosts, which nobody has.
      update(filter, controller, 1, true);
      EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), own);
    });
  ExpectAs(one, ranks);
  for (const Filter& filter : ranks)
  {
    EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("vtkGhostType"));
  }
}

TEST(RankPieces, GiveWayToOtherRuns)
{
  const auto largest = [](vtkDeformableSurface* filter)
  { filter->SetKeepComponents(vtkDeformableSurface::LargestComponent); };
  const Filter one = OneRank();
  const Filter oneOfLargest = OneRank(largest);
  EXPECT_LT(FactOf(oneOfLargest, "NumberOfComponents"), FactOf(one, "NumberOfComponents"));
  Ranks ranks = RunRanks(2, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      // A level that is whole, then pieces, then a choice of what they have not.
      filter->SetFinestLevel(1);
      ThreadControllers::Update(filter, controller);
      filter->SetFinestLevel(0);
      ThreadControllers::Update(filter, controller);
      largest(filter);
      ThreadControllers::Update(filter, controller);
    });
  ExpectAs(oneOfLargest, ranks);
  ranks = RunRanks(2, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      ThreadControllers::Update(filter, controller);
      filter->ForgetRun();
      filter->SetReleaseDataFlag(1); // Nothing is kept.
      filter->Modified();
      ThreadControllers::Update(filter, controller);
    });
  ExpectAs(one, ranks);
}

TEST(RankPieces, OfARunThatIsStopped)
{
  const Filter one = OneRank();
  const Ranks ranks = RunRanks(3, BallsFilter,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      {
        ProgressListener stops(filter);
        stops.StopAt = controller->GetLocalProcessId() == 0 ? 0.8 : 2.0;
        ThreadControllers::Update(filter, controller);
      }
      EXPECT_EQ(StopReasonOf(filter), "cancelled");
      EXPECT_EQ(FactOf(filter, "Level"), 0.0);
      EXPECT_TRUE(filter->GetOutput()->GetPointData()->GetGlobalIds());
      EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
      // It is stopped once more, before it is there, then goes on.
      filter->SetTimeLimit(1e-9);
      filter->Modified();
      ThreadControllers::Update(filter, controller);
      EXPECT_EQ(StopReasonOf(filter), "time limit");
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      filter->SetTimeLimit(0.0);
      ThreadControllers::Update(filter, controller);
      EXPECT_NE(StopReasonOf(filter), "time limit");
    });
  ExpectAs(one, ranks);
}

TEST(RankPieces, OfARunThatGoesOnAfterAStopAnywhere)
{
  const Filter one = OneRank();
  for (const double share : { 0.2, 0.35, 0.5, 0.65, 0.9 })
  {
    SCOPED_TRACE(share);
    const Ranks ranks = RunRanks(2, BallsFilter,
      [share](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
      {
        {
          ProgressListener stops(filter);
          stops.StopAt = controller->GetLocalProcessId() == 0 ? share : 2.0;
          Update(filter, controller);
        }
        EXPECT_EQ(StopReasonOf(filter), "cancelled");
        // What rests is where the ranks have it.
        filter->SetNumberOfThreads(2);
        Update(filter, controller);
      });
    ExpectAs(one, ranks);
  }
}

TEST(RankPieces, AreNotUnitedWhereARunIsKeptToGoOnFrom)
{
  const auto make = [](vtkMultiProcessController* controller)
  {
    Filter filter = BallsFilter(controller);
    filter->ProfileOn();
    return filter;
  };
  // The last row of a level has what is sent after it, too.
  const auto sent = [](const Ranks& ranks)
  {
    vtkTable* history = ranks.front()->GetHistory();
    double bytes = 0.0;
    for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
    {
      const bool isOfLevel1 = history->GetValueByName(row, "Level").ToInt() == 1;
      bytes = isOfLevel1 ? history->GetValueByName(row, "SentBytes").ToDouble() : bytes;
    }
    return bytes;
  };
  const Ranks gone = RunRanks(2, make,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      filter->SetReleaseDataFlag(1);
      Update(filter, controller);
    });
  const Ranks kept = RunRanks(2, make,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      filter->SetFinestLevel(1);
      Update(filter, controller);
      filter->SetFinestLevel(0);
      Update(filter, controller);
    });
  EXPECT_GT(sent(gone), 0.0);
  EXPECT_EQ(sent(kept), sent(gone));
  ExpectAs(OneRank(), kept);
}

TEST(RankPieces, AreNoneWhereACheckpointStays)
{
  // From it another run may go on, which needs all.
  const TemporaryFolder folder;
  const auto make = [&folder](vtkMultiProcessController* controller)
  {
    const Filter filter = BallsFilter(controller);
    filter->SetScratchDirectory(folder.Path().c_str());
    filter->LeaveCheckpoints();
    return filter;
  };
  RunRanks(2, make, Update);
  EXPECT_EQ(folder.Names().size(), 1u);
  const auto goOn = [](vtkDeformableSurface* filter) { filter->SetFinestLevel(-1); };
  const Ranks ranks = RunRanks(3, make, // others than before
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      goOn(filter);
      filter->ResumeOn();
      Update(filter, controller);
    });
  EXPECT_EQ(ranks.front()->GetResumedLevel(), 0);
  ExpectAs(OneRank(goOn), ranks);
}

TEST(RankPieces, AreWholeInTheCheckpointOfACoarserLevel)
{
  const TemporaryFolder folder;
  const auto make = [&folder](vtkMultiProcessController* controller)
  {
    const Filter filter = BallsFilter(controller);
    filter->SetReleaseDataFlag(1);
    filter->SetScratchDirectory(folder.Path().c_str());
    filter->LeaveCheckpoints();
    return filter;
  };
  RunRanks(2, make,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      ProgressListener stops(filter);
      stops.StopAt = controller->GetLocalProcessId() == 0 ? 0.8 : 2.0;
      Update(filter, controller);
      EXPECT_EQ(FactOf(filter, "Level"), 0.0);
    });
  const Ranks ranks = RunRanks(2, make,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      filter->ResumeOn();
      Update(filter, controller);
    });
  EXPECT_EQ(ranks.front()->GetResumedLevel(), 1);
  ExpectAs(OneRank(), ranks);
}

TEST(RankPieces, OfNothing)
{
  // Coarser levels show what the finest does not.
  const auto make = [](vtkMultiProcessController* controller)
  {
    vtkNew<vtkImagePyramid> pyramid;
    pyramid->SetInputData(TwoBalls());
    pyramid->Update();
    auto levels = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    levels->ShallowCopy(pyramid->GetOutput());
    auto* finest = vtkImageData::SafeDownCast(levels->GetBlock(0));
    finest->GetPointData()->GetScalars()->Fill(0.0);
    finest->SetScalarComponentFromDouble(9, 9, 9, 0, 100.0); // Where no surface comes.
    const Filter filter = FilterOf(levels, controller);
    filter->SetRecovery(vtkDeformableSurface::NoRecovery);
    return filter;
  };
  const Filter one = make(nullptr);
  one->Update();
  EXPECT_EQ(StopReasonOf(one), "vanished");
  const Ranks ranks = RunRanks(3, make, Update);
  ExpectAs(one, ranks);
  EXPECT_EQ(ranks.back()->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(RankPieces, OfNoneOfTheComponents)
{
  const auto choose = [](vtkDeformableSurface* filter)
  {
    filter->SetKeepComponents(vtkDeformableSurface::LargeComponents);
    filter->SetMinimumComponentVolume(1e6);
  };
  const Filter one = OneRank(choose);
  EXPECT_EQ(one->GetOutput()->GetNumberOfPoints(), 0);
  const Ranks ranks = RunRanks(3, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      choose(filter);
      const MessagesOf warnings(filter, vtkCommand::WarningEvent);
      Update(filter, controller);
      EXPECT_EQ(warnings.Get().find("leaves none of the components") != std::string::npos,
        controller->GetLocalProcessId() == 0);
    });
  ExpectAs(one, ranks);
}

TEST(RankPieces, ShowOtherComponentsWithoutAnotherRun)
{
  const auto largest = [](vtkDeformableSurface* filter)
  { filter->SetKeepComponents(vtkDeformableSurface::LargestComponent); };
  const auto show = [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
  {
    const ProgressListener progress(filter);
    Update(filter, controller);
    EXPECT_TRUE(std::none_of(progress.Shares.begin(), progress.Shares.end(),
      [](double share) { return share > 0.0 && share < 1.0; }));
  };
  const auto begin = [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
  {
    if (controller->GetLocalProcessId() == 0)
    {
      filter->GetNeedsUpdate(); // As a window asks, of the first rank only.
    }
    Update(filter, controller);
  };
  const Filter one = OneRank();
  Ranks ranks = RunRanks(3, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      begin(filter, controller);
      largest(filter);
      show(filter, controller);
    });
  const Filter oneOfLargest = OneRank(largest);
  ExpectAs(oneOfLargest, ranks);
  // Of its own piece each has shown what is wanted: a whole would be cut evenly.
  EXPECT_GT(std::abs(ranks.front()->GetOutput()->GetNumberOfCells() -
              oneOfLargest->GetOutput()->GetNumberOfCells() / 3),
    1);
  ranks = RunRanks(3, BallsFilter,
    [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      largest(filter);
      begin(filter, controller);
      filter->SetKeepComponents(vtkDeformableSurface::AllComponents);
      show(filter, controller);
    });
  ExpectAs(one, ranks);
}
