// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces that several ranks ask for: the first takes the pieces of the image together, and each
// gets a piece of what one process would make.

#include "RankFilterTools.h"
#include "TemporaryFolder.h"
#include "TestPrelude.h"
#include "vtkImagePyramid.h"
#include "vtkVolumeToSurface.h"

#include <vtkErrorCode.h>
#include <vtkIntArray.h>
#include <vtkSphereSource.h>

#include <chrono>
#include <new>
#include <thread>

using namespace volumic;

namespace
{
using Filter = vtkVolumeToSurface;
using Work = std::function<void(Filter*, vtkMultiProcessController*)>;
using Image = vtkSmartPointer<vtkImageData>;

Image Ball()
{
  return BallImage(32, 32, 32);
}

/** With NaN here and there, and hidden cells about where pieces meet. */
Image HoledBall()
{
  const Image image = BallImage(32, 30, 28);
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  for (vtkIdType v = 0; v < voxels->GetNumberOfTuples(); v += 97)
  {
    voxels->SetTuple1(v, std::numeric_limits<double>::quiet_NaN());
  }
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(image->GetNumberOfCells());
  for (vtkIdType c = 0; c < ghosts->GetNumberOfTuples(); ++c)
  {
    ghosts->SetValue(c, c % 31 > 13 && c % 31 < 17 ? vtkDataSetAttributes::HIDDENCELL : 0);
  }
  image->GetCellData()->AddArray(ghosts);
  return image;
}

/** The voxels are cells. */
Image CellBall()
{
  const Image image = BallImage(30, 30, 30);
  auto cells = Image::New();
  cells->SetExtent(-3, 27, 2, 32, 0, 30);
  cells->SetSpacing(1.0, 0.75, 1.5);
  cells->GetCellData()->SetScalars(image->GetPointData()->GetScalars());
  return cells;
}

void Set(Filter* filter)
{
  filter->SetIsoValue(50.0);
  filter->SetSnapshotInterval(40);
}

void Update(Filter* filter, vtkMultiProcessController* controller)
{
  ThreadControllers::Update(filter, controller);
}

/** What one rank alone has. */
vtkSmartPointer<Filter> OneRank(
  const std::function<Image()>& image = Ball, const Choice& set = [](vtkDeformableSurface*) {})
{
  return OnRanks<Filter>(1, image,
    [&](Filter* filter, vtkMultiProcessController*)
    {
      Set(filter);
      set(filter);
      filter->Update();
    })[0];
}

std::vector<vtkSmartPointer<Filter>> RunRanks(int count, const Work& work)
{
  return OnRanks<Filter>(count, Ball,
    [&work](Filter* filter, vtkMultiProcessController* controller)
    {
      Set(filter);
      work(filter, controller);
    });
}

template <typename Get>
auto OfAll(const std::vector<vtkSmartPointer<Filter>>& ranks, const Get& get)
{
  std::vector<decltype(get(ranks.front().Get()))> all;
  for (Filter* filter : ranks)
  {
    all.push_back(get(filter));
  }
  return all;
}

std::vector<vtkPolyData*> SurfacesOf(const std::vector<vtkSmartPointer<Filter>>& ranks)
{
  return OfAll(ranks, [](Filter* filter) { return filter->GetOutput(); });
}

std::string StopReasonOf(vtkDeformableSurface* filter)
{
  return vtkStringArray::SafeDownCast(
    filter->GetOutput()->GetFieldData()->GetAbstractArray("StopReason"))
    ->GetValue(0);
}

void ExpectAs(Filter* one, const std::vector<vtkSmartPointer<Filter>>& ranks)
{
  ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
  ExpectBlocksOf(
    one->GetLevels(), OfAll(ranks, [](Filter* filter) { return filter->GetLevels(); }));
  ExpectBlocksOf(
    one->GetSnapshots(), OfAll(ranks, [](Filter* filter) { return filter->GetSnapshots(); }));
  for (Filter* filter : ranks)
  {
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    vtkTable* history = filter->GetHistory();
    ASSERT_EQ(history->GetNumberOfColumns(), one->GetHistory()->GetNumberOfColumns());
    EXPECT_EQ(history->GetNumberOfRows(),
      filter == ranks.front() ? one->GetHistory()->GetNumberOfRows() : 0);
    for (vtkIdType c = 0; c < history->GetNumberOfColumns(); ++c)
    {
      EXPECT_STREQ(history->GetColumnName(c), one->GetHistory()->GetColumnName(c));
    }
  }
}
}

TEST(RankSurfaces, AreOneSurfaceInAPieceForEachRank)
{
  struct Case
  {
    Image (*Make)();
    Choice Set = [](vtkDeformableSurface*) {};
  };
  const TemporaryFolder folder;
  const std::vector<Case> cases = { { Ball }, { HoledBall }, { CellBall },
    { HoledBall,
      [&folder](vtkDeformableSurface* filter)
      {
        filter->SetMemoryLimit(4000);
        filter->SetScratchDirectory(folder.Path().c_str());
      } },
    { Ball, [](vtkDeformableSurface* filter) { filter->SetEdgeLength(2.0); } } };
  for (std::size_t c = 0; c < cases.size(); ++c)
  {
    const auto one = OneRank(cases[c].Make, cases[c].Set);
    EXPECT_GT(one->GetOutput()->GetNumberOfCells(), 300);
    for (const int count : { 2, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(count) + " ranks, case " + std::to_string(c));
      const auto ranks = OnRanks<Filter>(count, cases[c].Make,
        [&](Filter* filter, vtkMultiProcessController* controller)
        {
          Set(filter);
          cases[c].Set(filter);
          Update(filter, controller);
        });
      ExpectAs(one, ranks);
    }
  }
}

TEST(RankSurfaces, OfAPyramidInPieces)
{
  const auto make = [](Filter* filter, vtkMultiProcessController* controller)
  {
    vtkNew<vtkImagePyramid> pyramid;
    pyramid->SetController(controller);
    pyramid->SetInputConnection(filter->GetInputConnection(0, 0));
    const auto surface = vtkSmartPointer<vtkDeformableSurface>::New();
    surface->SetController(controller);
    surface->SetInputConnection(pyramid->GetOutputPort());
    surface->SetIsoValue(50.0);
    ThreadControllers::Update(surface, controller);
    EXPECT_EQ(surface->GetErrorCode(), vtkErrorCode::NoError);
    filter->GetOutput()->ShallowCopy(surface->GetOutput());
    surface->SetController(nullptr);
    pyramid->SetController(nullptr);
  };
  const auto one = RunRanks(1, make);
  EXPECT_GT(one[0]->GetOutput()->GetNumberOfCells(), 300);
  ExpectPiecesOf(one[0]->GetOutput(), SurfacesOf(RunRanks(3, make)));
}

TEST(RankSurfaces, HaveTheGhostsThatAreAskedForWithoutAnotherRun)
{
  const auto one = OneRank();
  vtkPolyData* whole = one->GetOutput();
  const auto ranks = RunRanks(3,
    [](Filter* filter, vtkMultiProcessController* controller)
    {
      Update(filter, controller);
      EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("vtkGhostType"));
      const ProgressListener progress(filter);
      ThreadControllers::Update(filter, controller, 2);
      EXPECT_TRUE(progress.Shares.empty() || progress.Shares.back() == 1.0) << "no other run";
    });
  ExpectPiecesOf(whole, SurfacesOf(ranks));
  for (vtkPolyData* piece : SurfacesOf(ranks))
  {
    // Points that can be reached over two triangles from the own ones.
    std::set<vtkIdType> points;
    std::size_t triangles = 0;
    for (vtkIdType t = 0; t < piece->GetNumberOfCells(); ++t)
    {
      vtkNew<vtkIdList> corners;
      piece->GetCellPoints(t, corners);
      for (const vtkIdType corner : *corners)
      {
        if (!IsGhost(piece->GetCellData(), t))
        {
          points.insert(IdOf(piece, corner));
        }
      }
    }
    const std::set<vtkIdType> own = points;
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
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      EXPECT_EQ(IsGhost(piece->GetPointData(), p), own.count(IdOf(piece, p)) == 0);
    }
  }
}

TEST(RankSurfaces, EndOnAllRanksWithTheErrorOfOneAndWorkAgain)
{
  const auto one = OneRank();
  const auto ranks = RunRanks(3,
    [](Filter* filter, vtkMultiProcessController* controller)
    {
      const int rank = controller->GetLocalProcessId();
      vtkAlgorithmOutput* source = filter->GetInputConnection(0, 0);
      vtkNew<vtkSphereSource> sphere;
      vtkNew<PieceSource> elsewhere;
      elsewhere->Whole = Ball();
      elsewhere->Whole->SetSpacing(1.0, 2.0, 1.0);
      vtkNew<PieceSource> nothing;
      nothing->Whole = Ball();
      nothing->Whole->SetExtent(0, -1, 0, -1, 0, -1);
      struct Case
      {
        int Bad;
        vtkAlgorithmOutput* Input;
        const char* Words;
      };
      for (const Case& is :
        { Case{ 0, sphere->GetOutputPort(), "it is a vtkPolyData; an image" },
          Case{ 2, sphere->GetOutputPort(), "it is a vtkPolyData; an image" },
          Case{ 1, elsewhere->GetOutputPort(), "direction differ at process 1" },
          Case{ 1, nothing->GetOutputPort(), "only a part of the voxels of the image, 32 x 32" } })
      {
        SCOPED_TRACE(is.Words);
        filter->SetInputConnection(rank == is.Bad ? is.Input : source);
        filter->Modified();
        const MessagesOf errors(filter);
        Update(filter, controller);
        EXPECT_TRUE(errors.Has(is.Words)) << errors.Get();
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
        EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
        EXPECT_EQ(filter->GetLevels()->GetNumberOfBlocks(), 0u);
      }
      // What fails while the first one works.
      filter->SetInputConnection(source);
      for (const int bad : { 0, 2 })
      {
        bool isBad = rank == bad;
        const ProgressHook hook(filter,
          [&isBad](vtkAlgorithm*, const std::string&, double share)
          {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            if (isBad && share > 0.0)
            {
              isBad = false;
              throw std::bad_alloc();
            }
          });
        filter->Modified();
        const MessagesOf errors(filter);
        Update(filter, controller);
        EXPECT_TRUE(errors.Has("the memory does not suffice for the surface")) << errors.Get();
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UnknownError);
      }
      filter->Modified();
      Update(filter, controller);
    });
  ExpectAs(one, ranks);
}

TEST(RankSurfaces, StopWhereAnyRankIsAskedToAndGoOn)
{
  const auto one = OneRank();
  for (const int canceller : { 0, 2 })
  {
    SCOPED_TRACE(canceller);
    const auto ranks = RunRanks(3,
      [canceller](Filter* filter, vtkMultiProcessController* controller)
      {
        ProgressListener cancels(filter);
        cancels.StopAt = controller->GetLocalProcessId() == canceller ? 0.03 : 2.0;
        // Long enough for the others to hear of it.
        const ProgressHook wait(filter,
          [](vtkAlgorithm*, const std::string&, double)
          { std::this_thread::sleep_for(std::chrono::milliseconds(10)); });
        Update(filter, controller);
        EXPECT_EQ(StopReasonOf(filter), "cancelled");
        cancels.StopAt = 2.0;
        filter->Modified();
        Update(filter, controller);
        EXPECT_NE(StopReasonOf(filter), "cancelled");
      });
    ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
  }
}

TEST(RankSurfaces, AreMadeAnewWhereOneRankHasChanged)
{
  const auto ranks = RunRanks(2,
    [](Filter* filter, vtkMultiProcessController* controller)
    {
      Update(filter, controller);
      if (controller->GetLocalProcessId() == 1)
      {
        filter->Modified();
      }
      const ProgressListener progress(filter);
      ThreadControllers::Update(filter, controller, 1);
      EXPECT_TRUE(progress.Shares.size() > 2 || controller->GetLocalProcessId() > 0) << "another run";
      // Another level of what is kept.
      filter->SetFinestLevel(1);
      Update(filter, controller);
    });
  ExpectPiecesOf(
    OneRank(Ball, [](vtkDeformableSurface* filter) { filter->SetFinestLevel(1); })->GetOutput(),
    SurfacesOf(ranks));
}

TEST(RankSurfaces, OfOneRankWhereItAsksForAnotherPiece)
{
  // As vtkCleanPolyData asks; nobody waits for anyone.
  const auto ranks = RunRanks(2,
    [](Filter* filter, vtkMultiProcessController* controller)
    { filter->UpdatePiece(0, controller->GetLocalProcessId() == 0 ? 1 : 0, 0); });
  ExpectSameOutputs(OneRank(), ranks[0]);
  EXPECT_EQ(ranks[1]->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(RankSurfaces, StartFromASurfaceInPieces)
{
  const auto take = [](vtkDeformableSurface* filter, vtkAlgorithm* source)
  {
    filter->SetInitialSurfaceConnection(source->GetOutputPort());
    filter->SetInitialization(vtkDeformableSurface::InputSurface);
    filter->SetCoarsestLevel(0);
  };
  for (const bool haveIds : { true, false })
  {
    const auto make = [&](Filter* filter, vtkMultiProcessController* controller)
    {
      const auto before = vtkSmartPointer<Filter>::New();
      before->SetController(controller);
      before->SetInputConnection(filter->GetInputConnection(0, 0));
      Set(before);
      vtkNew<vtkSphereSource> sphere;
      sphere->SetCenter(15.5, 15.5, 15.5);
      sphere->SetRadius(10.0);
      take(filter, haveIds ? static_cast<vtkAlgorithm*>(before) : sphere);
      Update(filter, controller);
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      vtkFieldData* facts = filter->GetOutput()->GetFieldData();
      EXPECT_EQ(facts->GetArray("EulerCharacteristic")->GetTuple1(0), 2.0);
      before->SetController(nullptr);
    };
    const auto ranks = RunRanks(3, make);
    if (haveIds)
    {
      ExpectPiecesOf(RunRanks(1, make)[0]->GetOutput(), SurfacesOf(ranks));
    }
  }
}
