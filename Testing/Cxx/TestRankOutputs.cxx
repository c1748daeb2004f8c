// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "ThreadControllers.h"
#include "vtkVolumeToSurface.h"

#include <vtkErrorCode.h>
#include <vtkIntArray.h>
#include <vtkSphereSource.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTriangle.h>
#include <vtkUnsignedCharArray.h>

#include <chrono>

using namespace volumic;

namespace
{
using Filter = vtkSmartPointer<vtkDeformableSurface>;

/** The filters of all ranks, when they are through. */
using Ranks = std::vector<Filter>;

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

/** Has each rank make a filter and do something with it. */
Ranks RunRanks(
  int count, const std::function<void(vtkDeformableSurface*, vtkMultiProcessController*)>& work)
{
  Ranks filters(static_cast<std::size_t>(count));
  ThreadControllers::Run(count,
    [&](vtkMultiProcessController* controller)
    {
      Filter filter = BallFilter(controller);
      work(filter, controller);
      filter->SetController(nullptr);
      filters[static_cast<std::size_t>(controller->GetLocalProcessId())] = filter;
    });
  return filters;
}

Ranks Update(int count)
{
  return RunRanks(count, [](vtkDeformableSurface* filter, vtkMultiProcessController* controller)
    { ThreadControllers::Update(filter, controller); });
}

std::vector<vtkPolyData*> SurfacesOf(const Ranks& ranks)
{
  std::vector<vtkPolyData*> surfaces;
  for (const Filter& filter : ranks)
  {
    surfaces.push_back(filter->GetOutput());
  }
  return surfaces;
}

vtkIdType IdOf(vtkPolyData* piece, vtkIdType point)
{
  return static_cast<vtkIdType>(piece->GetPointData()->GetGlobalIds()->GetTuple1(point));
}

/** Values of all arrays of a tuple, but for what only pieces have. */
std::vector<double> ValuesOf(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  std::vector<double> values;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    const std::string name = array->GetName();
    for (int c = 0; name != "GlobalIds" && name != "vtkGhostType" &&
         c < array->GetNumberOfComponents();
         ++c)
    {
      values.push_back(array->GetComponent(tuple, c));
    }
  }
  return values;
}

bool IsGhost(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  auto* types = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
  return types && types->GetValue(tuple) != 0;
}

/** Each triangle of the whole is one of one piece, and all is as it is there, bit by bit. */
void ExpectPiecesOf(vtkPolyData* whole, const std::vector<vtkPolyData*>& pieces)
{
  std::map<std::vector<vtkIdType>, vtkIdType> triangles;
  for (vtkIdType t = 0; t < whole->GetNumberOfCells(); ++t)
  {
    vtkNew<vtkIdList> corners;
    whole->GetCellPoints(t, corners);
    triangles[{ corners->begin(), corners->end() }] = t;
  }
  std::set<vtkIdType> found;
  for (vtkPolyData* piece : pieces)
  {
    ASSERT_TRUE(piece->GetPointData()->GetGlobalIds());
    EXPECT_STREQ(piece->GetPointData()->GetGlobalIds()->GetName(), "GlobalIds");
    ASSERT_TRUE(piece->GetPointData()->GetNormals());
    ExpectSameArrays(whole->GetFieldData(), piece->GetFieldData());
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      const vtkIdType id = IdOf(piece, p);
      double own[3];
      double of[3];
      piece->GetPoint(p, own);
      whole->GetPoint(id, of);
      ASSERT_TRUE(std::equal(own, own + 3, of)) << id;
      ASSERT_EQ(ValuesOf(piece->GetPointData(), p), ValuesOf(whole->GetPointData(), id));
    }
    for (vtkIdType t = 0; t < piece->GetNumberOfCells(); ++t)
    {
      vtkNew<vtkIdList> corners;
      piece->GetCellPoints(t, corners);
      std::vector<vtkIdType> ids;
      for (const vtkIdType corner : *corners)
      {
        ids.push_back(IdOf(piece, corner));
      }
      ASSERT_EQ(triangles.count(ids), 1u);
      const vtkIdType triangle = triangles[ids];
      ASSERT_EQ(ValuesOf(piece->GetCellData(), t), ValuesOf(whole->GetCellData(), triangle));
      if (!IsGhost(piece->GetCellData(), t))
      {
        EXPECT_TRUE(found.insert(triangle).second) << "twice: " << triangle;
      }
    }
  }
  EXPECT_EQ(found.size(), triangles.size());
}

void ExpectBlocksOf(vtkMultiBlockDataSet* whole, const std::vector<vtkMultiBlockDataSet*>& ranks)
{
  ASSERT_GT(whole->GetNumberOfBlocks(), 0u);
  for (unsigned int block = 0; block < whole->GetNumberOfBlocks(); ++block)
  {
    std::vector<vtkPolyData*> pieces;
    for (vtkMultiBlockDataSet* of : ranks)
    {
      ASSERT_EQ(of->GetNumberOfBlocks(), whole->GetNumberOfBlocks());
      EXPECT_STREQ(of->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()),
        whole->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()));
      pieces.push_back(vtkPolyData::SafeDownCast(of->GetBlock(block)));
      ASSERT_EQ(pieces.back() != nullptr, whole->GetBlock(block) != nullptr);
    }
    if (whole->GetBlock(block))
    {
      ExpectPiecesOf(vtkPolyData::SafeDownCast(whole->GetBlock(block)), pieces);
    }
  }
}

std::string StopReasonOf(vtkDeformableSurface* filter)
{
  return vtkStringArray::SafeDownCast(
    filter->GetOutput()->GetFieldData()->GetAbstractArray("StopReason"))
    ->GetValue(0);
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
