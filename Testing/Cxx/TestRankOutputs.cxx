// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RankOutputTestTools.h"

#include <vtkErrorCode.h>
#include <vtkIntArray.h>
#include <vtkSphereSource.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <chrono>

using namespace volumic;

namespace
{
/** A filter for a ball; the image of its own: threads share nothing. */
Filter BallFilter(vtkMultiProcessController* controller)
{
  auto filter = Filter::New();
  filter->SetController(controller);
  filter->SetInputData(BallImage(32, 32, 32));
  filter->SetIsoValue(50.0);
  filter->SetSnapshotInterval(40);
  filter->SetNumberOfThreads(1);
  return filter;
}

/** What one rank alone has. */
Filter OneRank()
{
  Filter filter = BallFilter(nullptr);
  filter->Update();
  return filter;
}

Ranks RunRanks(int count, const RankWork& work)
{
  return volumic::RunRanks(count, BallFilter, work);
}

Ranks Update(int count)
{
  return RunRanks(count, [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    { ThreadControllers::Update(filter, controller); });
}

TEST(RankOutputs, OneSurfaceInAPieceForEachRank)
{
  const Filter one = OneRank();
  for (const int count : { 1, 2, 3, 4 })
  {
    SCOPED_TRACE(count);
    const Ranks ranks = Update(count);
    if (count == 1)
    {
      ExpectSameOutputs(one, ranks.front());
      continue;
    }
    const std::vector<vtkPolyData*> pieces = SurfacesOf(ranks);
    ExpectPiecesOf(one->GetOutput(), pieces);
    std::vector<vtkMultiBlockDataSet*> levels;
    std::vector<vtkMultiBlockDataSet*> snapshots;
    for (const Filter& filter : ranks)
    {
      EXPECT_NEAR(filter->GetOutput()->GetNumberOfCells(),
        one->GetOutput()->GetNumberOfCells() / count, 1);
      EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("vtkGhostType"));
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      levels.push_back(filter->GetLevels());
      snapshots.push_back(filter->GetSnapshots());
      vtkTable* history = filter->GetHistory();
      ASSERT_EQ(history->GetNumberOfColumns(), one->GetHistory()->GetNumberOfColumns());
      EXPECT_EQ(history->GetNumberOfRows(),
        filter == ranks.front() ? one->GetHistory()->GetNumberOfRows() : 0);
      for (vtkIdType c = 0; c < history->GetNumberOfColumns(); ++c)
      {
        EXPECT_STREQ(history->GetColumnName(c), one->GetHistory()->GetColumnName(c));
        EXPECT_EQ(history->GetColumn(c)->GetDataType(),
          one->GetHistory()->GetColumn(c)->GetDataType());
      }
    }
    ExpectBlocksOf(one->GetLevels(), levels);
    ExpectBlocksOf(one->GetSnapshots(), snapshots);
  }
}

TEST(RankOutputs, GhostLevelsAreLayersOfTheOthersTriangles)
{
  const Filter one = OneRank();
  vtkPolyData* whole = one->GetOutput();
  const Ranks ranks = RunRanks(3,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      ThreadControllers::Update(filter, controller);
      const vtkMTimeType before = filter->GetHistory()->GetMTime();
      const ProgressListener progress(filter);
      ThreadControllers::Update(filter, controller, 2);
      EXPECT_GT(filter->GetHistory()->GetMTime(), before);
      EXPECT_TRUE(progress.Shares.empty() || progress.Shares.back() == 1.0) << "no other run";
    });
  ExpectPiecesOf(whole, SurfacesOf(ranks));
  for (vtkPolyData* piece : SurfacesOf(ranks))
  {
    // Points that can be reached over two triangles from the own ones.
    std::set<vtkIdType> points;
    std::set<vtkIdType> ownPoints;
    std::size_t triangles = 0;
    for (vtkIdType t = 0; t < piece->GetNumberOfCells(); ++t)
    {
      vtkNew<vtkIdList> corners;
      piece->GetCellPoints(t, corners);
      for (const vtkIdType corner : *corners)
      {
        IsGhost(piece->GetCellData(), t) ? 0 : ownPoints.insert(IdOf(piece, corner)).second;
      }
    }
    points = ownPoints;
    for (int layer = 0; layer < 2; ++layer)
    {
      std::set<vtkIdType> more = points;
      triangles = 0;
      for (vtkIdType t = 0; t < whole->GetNumberOfCells(); ++t)
      {
        vtkNew<vtkIdList> corners;
        whole->GetCellPoints(t, corners);
        if (std::any_of(corners->begin(), corners->end(),
              [&points](vtkIdType corner) { return points.count(corner) > 0; }))
        {
          more.insert(corners->begin(), corners->end());
          ++triangles;
        }
      }
      points = more;
    }
    EXPECT_EQ(static_cast<std::size_t>(piece->GetNumberOfCells()), triangles);
    EXPECT_EQ(static_cast<std::size_t>(piece->GetNumberOfPoints()), points.size());
    EXPECT_LT(ownPoints.size(), points.size());
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      EXPECT_EQ(IsGhost(piece->GetPointData(), p), ownPoints.count(IdOf(piece, p)) == 0);
    }
  }
}

TEST(RankOutputs, MoreRanksThanTriangles)
{
  // A run that is stopped before it has a surface: no triangle for anyone, but all arrays.
  const Ranks ranks = RunRanks(3,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      filter->SetTimeLimit(1e-9);
      ThreadControllers::Update(filter, controller);
    });
  for (const Filter& filter : ranks)
  {
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
    EXPECT_TRUE(filter->GetOutput()->GetPoints());
    EXPECT_TRUE(filter->GetOutput()->GetPointData()->HasArray("Residual"));
    EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("Component"));
    EXPECT_EQ(StopReasonOf(filter), "time limit");
  }
}

TEST(RankOutputs, AnErrorOfOneRankEndsTheRunOfAll)
{
  const Filter one = OneRank();
  const Ranks ranks = RunRanks(3,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      for (const int bad : { 0, 2, 1 })
      {
        SCOPED_TRACE(bad);
        filter->SetTimeLimit(controller->GetLocalProcessId() == bad ? -1.0 : 0.0);
        filter->Modified();
        const MessagesOf errors(filter);
        ThreadControllers::Update(filter, controller);
        EXPECT_TRUE(errors.Has("Time Limit is -1; it must be 0 (none) or more.")) << errors.Get();
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
        EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
        EXPECT_EQ(filter->GetLevels()->GetNumberOfBlocks(), 0u);
      }
      filter->SetTimeLimit(0.0);
      filter->Modified();
      ThreadControllers::Update(filter, controller);
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    });
  ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
}

TEST(RankOutputs, AnyRankCanCancel)
{
  const Filter one = OneRank();
  for (const int canceller : { 0, 2 })
  {
    SCOPED_TRACE(canceller);
    Ranks ranks = RunRanks(3,
      [canceller](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
      {
        const int rank = controller->GetLocalProcessId();
        ProgressListener cancels(filter);
        cancels.StopAt = rank == canceller ? 0.03 : 2.0;
        // Long enough for the others to hear of it.
        vtkNew<vtkCallbackCommand> wait;
        wait->SetCallback([](vtkObject*, unsigned long, void*, void*)
          { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
        filter->AddObserver(vtkCommand::ProgressEvent, wait);
        ThreadControllers::Update(filter, controller);
        EXPECT_EQ(StopReasonOf(filter), "cancelled");
        filter->RemoveObservers(vtkCommand::ProgressEvent);
        filter->Modified();
        ThreadControllers::Update(filter, controller);
        EXPECT_NE(StopReasonOf(filter), "cancelled");
      });
    ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
  }
}

TEST(RankOutputs, AChangeOnOneRankIsOneForAll)
{
  const Ranks ranks = RunRanks(2,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    {
      ThreadControllers::Update(filter, controller);
      // The output of rank 1 is to be made anew, and that of rank 0 has other ghost levels.
      if (controller->GetLocalProcessId() == 1)
      {
        filter->Modified();
      }
      ThreadControllers::Update(filter, controller, 1);
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      // Another level of what is kept.
      filter->SetFinestLevel(1);
      ThreadControllers::Update(filter, controller);
    });
  Filter one = BallFilter(nullptr);
  one->SetFinestLevel(1);
  one->Update();
  ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
}

TEST(RankOutputs, RanksThatAskForOtherPiecesWorkAlone)
{
  const Filter one = OneRank();
  // As vtkCleanPolyData asks; nobody waits for anyone.
  const Ranks ranks = RunRanks(2,
    [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    { filter->UpdatePiece(0, controller->GetLocalProcessId() == 0 ? 1 : 0, 0); });
  ExpectSameOutputs(one, ranks[0]);
  EXPECT_EQ(ranks[1]->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(RankOutputs, InitialSurfacesInPiecesAreJoined)
{
  const auto take = [](vtkDeformableSurface* filter, vtkAlgorithm* source)
  {
    filter->SetInitialSurfaceConnection(source->GetOutputPort());
    filter->SetInitialization(vtkDeformableSurface::InputSurface);
    filter->SetSnapshotInterval(0);
    filter->SetCoarsestLevel(0);
  };
  const Filter first = OneRank();
  Filter one = BallFilter(nullptr);
  take(one, first);
  one->Update();
  for (const bool isOurs : { true, false })
  {
    const Ranks ranks = RunRanks(3,
      [&](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
      {
        const Filter before = BallFilter(controller);
        vtkNew<vtkSphereSource> sphere;
        sphere->SetCenter(15.5, 15.5, 15.5);
        sphere->SetRadius(10.0);
        sphere->SetThetaResolution(11);
        sphere->SetPhiResolution(11);
        take(filter, isOurs ? static_cast<vtkAlgorithm*>(before) : sphere);
        ThreadControllers::Update(filter, controller);
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        vtkFieldData* facts = filter->GetOutput()->GetFieldData();
        EXPECT_EQ(facts->GetArray("EulerCharacteristic")->GetTuple1(0), 2.0);
      });
    if (isOurs)
    {
      ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
    }
  }
}
}
