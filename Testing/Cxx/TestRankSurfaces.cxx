// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces that several ranks ask for: the first takes the pieces of the
// image together, and each gets a piece of what one process would make.

#include "RankTestTools.h"
#include "TemporaryFolder.h"
#include "TestPrelude.h"
#include "vtkVolumeToSurface.h"

#include <vtkErrorCode.h>
#include <vtkSphereSource.h>
#include <vtkTrivialProducer.h>

#include <chrono>
#include <fstream>
#include <new>
#include <thread>

using namespace volumic;

namespace
{
using Filter = vtkVolumeToSurface;
using Work = std::function<void(Filter*, RankController*)>;
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
  vtkUnsignedCharArray* ghosts = image->AllocateCellGhostArray();
  for (vtkIdType c = 14; c < ghosts->GetNumberOfTuples(); c += 31)
  {
    ghosts->SetValue(c, vtkDataSetAttributes::HIDDENCELL);
  }
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

/** What one rank alone has. */
vtkSmartPointer<Filter> OneRank(
  const std::function<Image()>& image = Ball, const Choice& set = [](vtkDeformableSurface*) {})
{
  return OnRanks<Filter>(1, image,
    [&](Filter* filter, RankController*)
    {
      Set(filter);
      set(filter);
      filter->Update();
    })[0];
}

std::vector<vtkSmartPointer<Filter>> OnBall(int count, const Work& work)
{
  return OnRanks<Filter>(count, Ball,
    [&work](Filter* filter, RankController* controller)
    {
      Set(filter);
      work(filter, controller);
    });
}

template <typename Get>
auto OfAll(const std::vector<vtkSmartPointer<Filter>>& ranks, const Get& get)
{
  std::vector<decltype(get(ranks.front().Get()))> all;
  std::transform(ranks.begin(), ranks.end(), std::back_inserter(all), get);
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
    EXPECT_EQ(filter->GetHistory()->GetNumberOfColumns(), one->GetHistory()->GetNumberOfColumns());
    EXPECT_STREQ(filter->GetHistory()->GetColumnName(1), one->GetHistory()->GetColumnName(1));
    EXPECT_EQ(filter->GetHistory()->GetNumberOfRows(),
      filter == ranks.front() ? one->GetHistory()->GetNumberOfRows() : 0);
  }
}
}

TEST(RankSurfaces, AreOneSurfaceInAPieceForEachRank)
{
  struct Case
  {
    int Count;
    Image (*Make)();
    Choice Set = [](vtkDeformableSurface*) {};
  };
  for (const Case& is : { Case{ 2, CellBall }, Case{ 3, HoledBall },
         Case{ 3, Ball,
           [](vtkDeformableSurface* filter)
           {
             filter->SetIsoValue(-50.0);
             filter->SetUpperValue(50.0); // all but the ball
           } },
         Case{ 8, Ball, [](vtkDeformableSurface* filter) { filter->SetEdgeLength(2.0); } } })
  {
    SCOPED_TRACE(is.Count);
    const auto one = OneRank(is.Make, is.Set);
    EXPECT_GT(one->GetOutput()->GetNumberOfCells(), 300);
    ExpectAs(one,
      OnRanks<Filter>(is.Count, is.Make,
        [&](Filter* filter, RankController* controller)
        {
          Set(filter);
          is.Set(filter);
          UpdatePiece(filter, controller);
        }));
  }
}

TEST(RankSurfaces, OfAnImageThatIsPutTogetherInTheScratchFile)
{
  const TemporaryFolder folder;
  // Memory that lies in files of the folder, which have no name there.
  const auto bytesInScratch = [&folder]
  {
    std::size_t bytes = 0;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
    {
      std::size_t dash = 0;
      const std::size_t begin = std::stoull(line, &dash, 16);
      const std::size_t end = std::stoull(line.substr(dash + 1), nullptr, 16);
      bytes += line.find(folder.Path()) != std::string::npos ? end - begin : 0;
    }
    return bytes;
  };
  const auto image = [] { return BallImage(128, 64, 64); };
  const auto set = [&folder](vtkDeformableSurface* filter)
  {
    filter->SetMemoryLimit(4000);
    filter->SetScratchDirectory(folder.Path().c_str());
    filter->SetFinestLevel(2);
  };
  std::size_t before = 0;
  const auto ranks = OnRanks<Filter>(2, image,
    [&](Filter* filter, RankController* controller)
    {
      Set(filter);
      set(filter);
      const ProgressHook look(filter,
        [&, isFirst = controller->GetLocalProcessId() == 0](vtkAlgorithm*, const std::string&,
          double share) { before = isFirst && share == 0.0 ? bytesInScratch() : before; });
      UpdatePiece(filter, controller);
    });
  EXPECT_GE(before, std::size_t(4) * 128 * 64 * 64) << "before any level was made";
  ExpectPiecesOf(OneRank(image, set)->GetOutput(), SurfacesOf(ranks));
}

TEST(RankSurfaces, OfAPyramidInPieces)
{
  const auto make = [](Filter* filter, RankController* controller)
  {
    vtkNew<vtkImagePyramid> pyramid;
    pyramid->SetController(controller);
    pyramid->SetInputConnection(filter->GetInputConnection(0, 0));
    const auto surface = vtkSmartPointer<vtkDeformableSurface>::New();
    surface->SetController(controller);
    surface->SetInputConnection(pyramid->GetOutputPort());
    surface->SetIsoValue(50.0);
    UpdatePiece(surface, controller);
    EXPECT_EQ(surface->GetErrorCode(), vtkErrorCode::NoError);
    filter->GetOutput()->ShallowCopy(surface->GetOutput());
    surface->SetController(nullptr);
    pyramid->SetController(nullptr);
  };
  const auto one = OnBall(1, make);
  EXPECT_GT(one[0]->GetOutput()->GetNumberOfCells(), 300);
  ExpectPiecesOf(one[0]->GetOutput(), SurfacesOf(OnBall(3, make)));
}

TEST(RankSurfaces, HaveTheGhostsThatAreAskedForWithoutAnotherRun)
{
  const auto one = OneRank();
  vtkPolyData* whole = one->GetOutput();
  const auto ranks = OnBall(3,
    [](Filter* filter, RankController* controller)
    {
      UpdatePiece(filter, controller);
      EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("vtkGhostType"));
      const ProgressListener progress(filter);
      UpdatePiece(filter, controller, 2);
      EXPECT_TRUE(progress.Shares.empty() || progress.Shares.back() == 1.0) << "no other run";
    });
  ExpectPiecesOf(whole, SurfacesOf(ranks));
  for (vtkPolyData* piece : SurfacesOf(ranks))
  {
    std::set<vtkIdType> points;
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      if (!IsGhost(piece->GetPointData(), p))
      {
        points.insert(IdOf(piece, p));
      }
    }
    // Those that have a corner among the own points, or among those of such triangles.
    vtkIdType triangles = 0;
    for (int layer = 0; layer < 2; ++layer)
    {
      std::set<vtkIdType> more = points;
      triangles = 0;
      for (vtkIdType t = 0; t < whole->GetNumberOfCells(); ++t)
      {
        const std::vector<vtkIdType> corners = CornersOf(whole, t);
        if (std::any_of(corners.begin(), corners.end(),
              [&points](vtkIdType corner) { return points.count(corner) > 0; }))
        {
          more.insert(corners.begin(), corners.end());
          ++triangles;
        }
      }
      points = more;
    }
    EXPECT_EQ(piece->GetNumberOfCells(), triangles);
    EXPECT_EQ(static_cast<std::size_t>(piece->GetNumberOfPoints()), points.size());
  }
}

TEST(RankSurfaces, EndOnAllRanksWithTheErrorOfOneAndWorkAgain)
{
  const auto one = OneRank();
  const auto ranks = OnBall(3,
    [](Filter* filter, RankController* controller)
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
        UpdatePiece(filter, controller);
        EXPECT_TRUE(errors.Has(is.Words)) << errors.Get();
        EXPECT_EQ(errors.Get().find("ERROR: "), errors.Get().rfind("ERROR: ")) << errors.Get();
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
        UpdatePiece(filter, controller);
        EXPECT_TRUE(errors.Has("the memory does not suffice for the surface")) << errors.Get();
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UnknownError);
      }
      filter->Modified();
      UpdatePiece(filter, controller);
    });
  ExpectAs(one, ranks);
}

TEST(RankSurfaces, StopWhereAnyRankIsAskedToAndGoOn)
{
  const auto one = OneRank();
  for (const int canceller : { 0, 2 })
  {
    SCOPED_TRACE(canceller);
    const auto ranks = OnBall(3,
      [canceller](Filter* filter, RankController* controller)
      {
        ProgressListener cancels(filter);
        cancels.StopAt = controller->GetLocalProcessId() == canceller ? 0.03 : 2.0;
        // Long enough for the others to hear of it.
        const ProgressHook wait(filter,
          [](vtkAlgorithm*, const std::string&, double)
          { std::this_thread::sleep_for(std::chrono::milliseconds(10)); });
        UpdatePiece(filter, controller);
        EXPECT_EQ(StopReasonOf(filter), "cancelled");
        cancels.StopAt = 2.0;
        filter->Modified();
        UpdatePiece(filter, controller);
        EXPECT_NE(StopReasonOf(filter), "cancelled");
      });
    ExpectPiecesOf(one->GetOutput(), SurfacesOf(ranks));
  }
}

TEST(RankSurfaces, AreMadeAnewWhereOneRankHasChanged)
{
  const auto ranks = OnBall(2,
    [](Filter* filter, RankController* controller)
    {
      UpdatePiece(filter, controller);
      if (controller->GetLocalProcessId() == 1)
      {
        filter->Modified();
      }
      const ProgressListener progress(filter);
      UpdatePiece(filter, controller, 1);
      EXPECT_TRUE(progress.Shares.size() > 2 || controller->GetLocalProcessId() > 0)
        << "another run";
      // Another level of what is kept.
      filter->SetFinestLevel(1);
      UpdatePiece(filter, controller);
    });
  ExpectPiecesOf(
    OneRank(Ball, [](vtkDeformableSurface* filter) { filter->SetFinestLevel(1); })->GetOutput(),
    SurfacesOf(ranks));
}

TEST(RankSurfaces, OfOneRankWhereItAsksForAnotherPiece)
{
  const auto one = OneRank();
  // As vtkCleanPolyData asks, and in another order; nobody waits for anyone.
  for (const int pieces : { 1, 2 })
  {
    const auto ranks = OnBall(2,
      [pieces](Filter* filter, RankController* controller)
      {
        const bool isFirst = controller->GetLocalProcessId() == pieces - 1;
        filter->UpdatePiece(isFirst ? 0 : pieces - 1, isFirst ? pieces : 2 * pieces - 2, 0);
      });
    const auto all = static_cast<std::size_t>(pieces - 1);
    ExpectSameOutputs(one, ranks[all]);
    EXPECT_EQ(ranks[1 - all]->GetOutput()->GetNumberOfPoints(), 0);
  }
}

TEST(RankSurfaces, StartFromASurfaceInPieces)
{
  const auto take = [](vtkDeformableSurface* filter, vtkAlgorithm* source)
  {
    filter->SetInitialSurfaceConnection(source->GetOutputPort());
    filter->SetInitialization(vtkDeformableSurface::InputSurface);
    filter->SetCoarsestLevel(0);
  };
  // Pieces with ids and ghosts; pieces without; the same surface on all.
  for (const char kind : { 'i', 'p', 'a' })
  {
    const auto make = [&](Filter* filter, RankController* controller)
    {
      const auto before = vtkSmartPointer<Filter>::New();
      before->SetController(controller);
      before->SetInputConnection(filter->GetInputConnection(0, 0));
      Set(before);
      vtkNew<vtkSphereSource> sphere;
      sphere->SetCenter(15.5, 15.5, 15.5);
      sphere->SetRadius(10.0);
      vtkNew<vtkTrivialProducer> alike;
      sphere->Update();
      vtkNew<vtkPolyData> whole;
      whole->DeepCopy(sphere->GetOutput());
      alike->SetOutput(whole);
      if (kind == 'i')
      {
        UpdatePiece(before, controller, 1);
      }
      take(filter,
        kind == 'i'     ? static_cast<vtkAlgorithm*>(before)
          : kind == 'p' ? static_cast<vtkAlgorithm*>(sphere)
                        : alike);
      UpdatePiece(filter, controller);
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      vtkFieldData* facts = filter->GetOutput()->GetFieldData();
      EXPECT_EQ(facts->GetArray("EulerCharacteristic")->GetTuple1(0), 2.0);
      before->SetController(nullptr);
    };
    const auto ranks = OnBall(3, make);
    if (kind != 'p')
    {
      ExpectPiecesOf(OnBall(1, make)[0]->GetOutput(), SurfacesOf(ranks));
    }
  }
}
