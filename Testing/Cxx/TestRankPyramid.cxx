// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"
#include "PieceSource.h"
#include "ThreadControllers.h"
#include "vtkOtsuThreshold.h"
#include "vtkVolumeToSurface.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkImageAlgorithm.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

using namespace volumic;

namespace
{
using Image = vtkSmartPointer<vtkImageData>;

using MakeImage = std::function<Image()>;

/** The output of a pyramid as bytes, by level, with what it says of itself. */
struct Outcome
{
  std::vector<Image> Levels; ///< null: none
  std::string StopReason;
  double NaNs = -1;
  std::string Errors;
  std::string Warnings;
  unsigned long Code = 0;
};

Outcome OutcomeOf(vtkImagePyramid* pyramid)
{
  Outcome outcome;
  vtkMultiBlockDataSet* blocks = pyramid->GetOutput();
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    outcome.Levels.emplace_back(Level(blocks, h));
  }
  vtkFieldData* fields = blocks->GetFieldData();
  if (auto* reason = vtkStringArray::SafeDownCast(fields->GetAbstractArray("StopReason")))
  {
    outcome.StopReason = reason->GetValue(0);
    outcome.NaNs = fields->GetArray("NaNVoxels")->GetTuple1(0);
  }
  outcome.Code = pyramid->GetErrorCode();
  return outcome;
}

/** Without the place in the source, and without the address of who says it. */
std::string TextOf(const std::string& message)
{
  const std::size_t speaker = message.find("): ");
  return speaker == std::string::npos ? message : message.substr(speaker);
}

using Change = std::function<void(vtkImagePyramid*, vtkMultiProcessController*)>;

/** What so many ranks have of the pyramid of an image, by rank. */
std::vector<Outcome> RunRanks(int count, const MakeImage& make, int ghosts = 0,
  bool givesPieces = true, const Change& change = {})
{
  std::vector<Outcome> outcomes(static_cast<std::size_t>(count));
  ThreadControllers::Run(count,
    [&](vtkMultiProcessController* controller)
    {
      vtkNew<PieceSource> source;
      source->Whole = make();
      source->GivesPieces = givesPieces;
      vtkNew<vtkImagePyramid> pyramid;
      pyramid->SetController(controller);
      pyramid->SetInputConnection(source->GetOutputPort());
      pyramid->SetNumberOfLevels(4);
      pyramid->SetNumberOfThreads(1);
      if (change)
      {
        change(pyramid, controller);
      }
      const MessagesOf errors(pyramid);
      const MessagesOf warnings(pyramid, vtkCommand::WarningEvent);
      ThreadControllers::Update(pyramid, controller, ghosts);
      Outcome& outcome = outcomes[static_cast<std::size_t>(controller->GetLocalProcessId())];
      outcome = OutcomeOf(pyramid);
      outcome.Errors = TextOf(errors.Get());
      outcome.Warnings = TextOf(warnings.Get());
      pyramid->SetController(nullptr);
    });
  return outcomes;
}

bool AreSameBits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof(a)) == 0 || (std::isnan(a) && std::isnan(b));
}

/** Each voxel of a level is in a piece of a rank, and in all with the value of one rank alone. */
void ExpectPiecesOf(vtkImageData* whole, unsigned int h, const std::vector<Outcome>& ranks)
{
  std::vector<char> found(static_cast<std::size_t>(whole->GetNumberOfPoints()), 0);
  int differences = 0;
  for (const Outcome& rank : ranks)
  {
    vtkImageData* piece = rank.Levels[h];
    if (!piece)
    {
      continue;
    }
    EXPECT_TRUE(Voxels(piece));
    EXPECT_EQ(Voxels(piece)->GetDataType(), Voxels(whole)->GetDataType());
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ(piece->GetOrigin()[axis], whole->GetOrigin()[axis]);
      EXPECT_EQ(piece->GetSpacing()[axis], whole->GetSpacing()[axis]);
    }
    EXPECT_EQ(UnitOf(piece), UnitOf(whole));
    const int* e = piece->GetExtent();
    ForBox({ e[0], e[2], e[4] }, { e[1] + 1, e[3] + 1, e[5] + 1 },
      [&](int i, int j, int k)
      {
        int place[3] = { i, j, k };
        const vtkIdType inWhole = whole->ComputePointId(place);
        found[static_cast<std::size_t>(inWhole)] = 1;
        differences += !AreSameBits(Voxels(piece)->GetTuple1(piece->ComputePointId(place)),
          Voxels(whole)->GetTuple1(inWhole));
      });
  }
  EXPECT_EQ(differences, 0) << "level " << h;
  EXPECT_EQ(std::count(found.begin(), found.end(), 0), 0) << "level " << h;
}

void ExpectPiecesOfOne(const Outcome& one, const std::vector<Outcome>& ranks)
{
  for (const Outcome& rank : ranks)
  {
    EXPECT_EQ(rank.Errors, "");
    EXPECT_EQ(rank.StopReason, "complete");
    EXPECT_EQ(rank.NaNs, one.NaNs);
    ASSERT_EQ(rank.Levels.size(), one.Levels.size());
  }
  for (unsigned int h = 0; h < one.Levels.size(); ++h)
  {
    ExpectPiecesOf(one.Levels[h], h, ranks);
  }
}

/** Not at the origin, and its extent begins elsewhere. */
Image SomeImage(int type = VTK_SHORT)
{
  Image image = RandomImage(31, 26, 29, type);
  image->SetExtent(5, 35, -3, 22, 7, 35);
  image->SetOrigin(1.0, 2.0, 3.0);
  image->SetSpacing(1.0, 1.25, 0.75);
  return image;
}

/** With NaN, hidden points and hidden cells, also where pieces meet. */
Image HoledImage()
{
  Image image = SomeImage(VTK_FLOAT);
  vtkNew<vtkUnsignedCharArray> points;
  points->SetName(vtkDataSetAttributes::GhostArrayName());
  points->SetNumberOfTuples(image->GetNumberOfPoints());
  points->FillValue(0);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); i += 9)
  {
    points->SetValue(i, vtkDataSetAttributes::HIDDENPOINT);
  }
  image->GetPointData()->AddArray(points);
  vtkNew<vtkUnsignedCharArray> cells;
  cells->SetName(vtkDataSetAttributes::GhostArrayName());
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  // Most of them, so that a point at the border of a piece often has its visible cell beyond it.
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    cells->SetValue(i, i * 7919 % 101 > 15 ? vtkDataSetAttributes::HIDDENCELL : 0);
  }
  image->GetCellData()->AddArray(cells);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); i += 7)
  {
    Voxels(image)->SetTuple1(i, std::numeric_limits<float>::quiet_NaN());
  }
  return image;
}
}

TEST(RankPyramid, HasPiecesOfTheBitsOfOneRank)
{
  const MakeImage make = [] { return SomeImage(); };
  const Outcome one = RunRanks(1, make)[0];
  ASSERT_EQ(one.Levels.size(), 4u);
  for (const int count : { 2, 3, 4, 7 })
  {
    for (const int ghosts : { 0, 2 })
    {
      for (const bool givesPieces : { true, false })
      {
        SCOPED_TRACE(std::to_string(count) + " ranks");
        ExpectPiecesOfOne(one, RunRanks(count, make, ghosts, givesPieces));
      }
    }
  }
}

TEST(RankPyramid, MarksTheGhostsThatAreAskedFor)
{
  const std::vector<Outcome> none = RunRanks(2, [] { return SomeImage(); });
  const std::vector<Outcome> ghosts = RunRanks(2, [] { return SomeImage(); }, 1);
  for (std::size_t rank = 0; rank < 2; ++rank)
  {
    vtkImageData* piece = ghosts[rank].Levels[2];
    auto* marks = vtkUnsignedCharArray::SafeDownCast(
      piece->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
    ASSERT_TRUE(marks);
    vtkIdType own = 0;
    for (vtkIdType i = 0; i < marks->GetNumberOfTuples(); ++i)
    {
      own += marks->GetValue(i) == 0;
    }
    EXPECT_GT(piece->GetNumberOfCells(), own);
    EXPECT_EQ(own, none[rank].Levels[2]->GetNumberOfCells());
    EXPECT_FALSE(
      none[rank].Levels[2]->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  }
}

TEST(RankPyramid, LeavesOutVoxelsWithoutAValueWhereverTheyAre)
{
  const Outcome one = RunRanks(1, HoledImage)[0];
  EXPECT_GT(one.NaNs, 100.0);
  for (const int count : { 2, 4 })
  {
    const std::vector<Outcome> ranks = RunRanks(count, HoledImage);
    ExpectPiecesOfOne(one, ranks);
    EXPECT_EQ(ranks[0].Warnings, one.Warnings) << "of the whole, once";
    EXPECT_EQ(ranks[1].Warnings, "");
  }
}

TEST(RankPyramid, IsSpreadOverMoreRanksThanALevelHasVoxelsFor)
{
  const MakeImage make = [] { return RandomImage(7, 6, 5, VTK_FLOAT); };
  const Outcome one = RunRanks(1, make)[0];
  const std::vector<Outcome> ranks = RunRanks(12, make);
  ExpectPiecesOfOne(one, ranks);
  EXPECT_FALSE(ranks[11].Levels[3]) << "one voxel is not cut";
}

TEST(RankPyramid, ReportsTheErrorOfOneRankOnAllAndWorksAgain)
{
  const MakeImage make = []
  {
    Image image = SomeImage(VTK_FLOAT);
    Voxels(image)->SetTuple1(
      image->GetNumberOfPoints() - 2, std::numeric_limits<float>::infinity());
    return image;
  };
  const Outcome one = RunRanks(1, make)[0];
  EXPECT_NE(one.Errors, "");
  for (const Outcome& rank : RunRanks(3, make))
  {
    EXPECT_EQ(rank.Errors, one.Errors);
    EXPECT_EQ(rank.Code, vtkErrorCode::UserError);
    EXPECT_TRUE(rank.Levels.empty());
  }
  // One is asked for an array that is not there.
  const auto refuse = [&](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
  {
    const int rank = controller->GetLocalProcessId();
    if (rank == 2)
    {
      pyramid->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "none");
    }
    const MessagesOf errors(pyramid);
    ThreadControllers::Update(pyramid, controller);
    EXPECT_TRUE(Has(errors.Get(), "no point array 'none'"));
    EXPECT_EQ(pyramid->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UserError));
    pyramid->SetInputArrayToProcess(
      0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
    pyramid->Modified();
  };
  ExpectPiecesOfOne(RunRanks(1, [] { return SomeImage(); })[0],
    RunRanks(3, [] { return SomeImage(); }, 0, true, refuse));
}

TEST(RankPyramid, StopsOnAllRanksWhenOneIsAborted)
{
  const auto abortOnOne = [](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
  {
    if (controller->GetLocalProcessId() != 1)
    {
      return;
    }
    vtkNew<vtkCallbackCommand> abort;
    abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
      { static_cast<vtkImagePyramid*>(caller)->SetAbortExecute(1); });
    pyramid->AddObserver(vtkCommand::ProgressEvent, abort);
  };
  for (const Outcome& rank : RunRanks(3, [] { return SomeImage(); }, 0, true, abortOnOne))
  {
    EXPECT_EQ(rank.StopReason, "cancelled");
    EXPECT_EQ(rank.Errors, "");
    EXPECT_LT(rank.Levels.size(), 4u);
  }
}

TEST(RankPyramid, IsThereAgainForRanksThatWereAskedForNothingInBetween)
{
  // As vtkCleanPolyData does it; the first rank is not asked again, and would not answer.
  const auto askOthers = [](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
  {
    ThreadControllers::Update(pyramid, controller);
    if (controller->GetLocalProcessId() > 0)
    {
      pyramid->UpdatePiece(0, 0, 0);
      EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
    }
  };
  const MakeImage make = [] { return SomeImage(); };
  ExpectPiecesOfOne(RunRanks(1, make)[0], RunRanks(3, make, 0, true, askOthers));
}

TEST(RankPyramid, OtsuFindsTheThresholdOfTheWhole)
{
  const auto find = [](int count, std::vector<double>& found)
  {
    found.assign(static_cast<std::size_t>(count), 0.0);
    ThreadControllers::Run(count,
      [&](vtkMultiProcessController* controller)
      {
        vtkNew<PieceSource> source;
        source->Whole = HoledImage();
        vtkNew<vtkOtsuThreshold> otsu;
        otsu->SetController(controller);
        otsu->SetInputConnection(source->GetOutputPort());
        ThreadControllers::Update(otsu, controller);
        EXPECT_EQ(otsu->GetErrorCode(), 0ul);
        found[static_cast<std::size_t>(controller->GetLocalProcessId())] = otsu->GetThreshold();
        otsu->SetController(nullptr);
      });
  };
  std::vector<double> one;
  find(1, one);
  for (const int count : { 2, 4 })
  {
    std::vector<double> ranks;
    find(count, ranks);
    EXPECT_EQ(ranks, std::vector<double>(static_cast<std::size_t>(count), one[0]));
  }
}

namespace
{
/** The area and the triangles of the surface of an image that ranks hold in pieces. */
std::vector<double> SurfaceOf(int count, const MakeImage& make, bool throughPyramid)
{
  double area = 0.0;
  double triangles = 0.0;
  double iterations = 0.0;
  std::mutex mutex;
  ThreadControllers::Run(count,
    [&](vtkMultiProcessController* controller)
    {
      vtkNew<PieceSource> source;
      source->Whole = make();
      vtkNew<vtkImagePyramid> pyramid;
      pyramid->SetController(controller);
      pyramid->SetInputConnection(source->GetOutputPort());
      vtkSmartPointer<vtkDeformableSurface> surface = vtkSmartPointer<vtkVolumeToSurface>::New();
      if (throughPyramid)
      {
        surface = vtkSmartPointer<vtkDeformableSurface>::New();
        surface->SetIsoValue(50.0);
      }
      surface->SetInputConnection(
        throughPyramid ? pyramid->GetOutputPort() : source->GetOutputPort());
      surface->SetController(controller);
      surface->SetNumberOfThreads(1);
      const MessagesOf errors(surface);
      ThreadControllers::Update(surface, controller);
      EXPECT_EQ(errors.Get(), "");
      vtkPolyData* output = surface->GetOutput();
      const std::lock_guard<std::mutex> lock(mutex);
      triangles += static_cast<double>(output->GetNumberOfCells());
      area = output->GetFieldData()->GetArray("Area")->GetTuple1(0);
      iterations = output->GetFieldData()->GetArray("Iterations")->GetTuple1(0);
      surface->SetController(nullptr);
      pyramid->SetController(nullptr);
    });
  return { area, triangles, iterations };
}
}

TEST(RankPyramid, IsWhatSurfacesAreSearchedIn)
{
  const MakeImage ball = [] { return BallImage(30, 28, 26); };
  const std::vector<double> one = SurfaceOf(1, ball, true);
  EXPECT_GT(one[1], 100.0);
  EXPECT_EQ(SurfaceOf(3, ball, true), one);
  EXPECT_EQ(SurfaceOf(2, ball, false), SurfaceOf(1, ball, false));
}

TEST(RankPyramid, TakesCellsAsVoxels)
{
  const MakeImage cells = []
  {
    const Image ball = BallImage(30, 28, 26);
    auto image = Image::New();
    image->SetDimensions(31, 29, 27);
    image->GetCellData()->SetScalars(Voxels(ball));
    return image;
  };
  const std::vector<double> one = SurfaceOf(1, cells, false);
  EXPECT_GT(one[1], 100.0);
  EXPECT_EQ(SurfaceOf(3, cells, false), one);
}
