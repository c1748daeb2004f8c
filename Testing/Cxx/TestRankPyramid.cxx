// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Pyramids and thresholds that several ranks ask for.

#include "FilterTestTools.h"
#include "RankFilterTools.h"
#include "TestPrelude.h"
#include "vtkOtsuThreshold.h"

#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkTable.h>

#include <cstring>

using namespace volumic;

namespace
{
using Image = vtkSmartPointer<vtkImageData>;
using Pyramids = std::vector<vtkSmartPointer<vtkImagePyramid>>;
using Work = std::function<void(vtkImagePyramid*, vtkMultiProcessController*)>;

/** Not at the origin, its extent begins elsewhere; with an array beside its voxels. */
Image SomeImage()
{
  Image image = RandomImage(31, 26, 29, VTK_SHORT);
  image->SetExtent(5, 35, -3, 22, 7, 35);
  image->SetOrigin(1.0, 2.0, 3.0);
  image->SetSpacing(1.0, 1.25, 0.75);
  double quarter[9] = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
  image->SetDirectionMatrix(quarter);
  return image;
}

Pyramids RunRanks(int count, int ghosts = 0, const Work& before = {})
{
  return OnRanks<vtkImagePyramid>(count, SomeImage,
    [&](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
    {
      pyramid->SetNumberOfLevels(4);
      if (before)
      {
        before(pyramid, controller);
      }
      ThreadControllers::Update(pyramid, controller, ghosts);
    });
}

/** Each voxel of a level is in a piece of a rank, and in all with the value of one rank alone. */
void ExpectPiecesOf(vtkImagePyramid* one, const Pyramids& ranks)
{
  for (unsigned int h = 0; h < one->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    vtkImageData* whole = Level(one->GetOutput(), h);
    std::vector<char> found(static_cast<std::size_t>(whole->GetNumberOfPoints()), 0);
    for (vtkImagePyramid* rank : ranks)
    {
      EXPECT_EQ(rank->GetErrorCode(), vtkErrorCode::NoError);
      ASSERT_EQ(rank->GetOutput()->GetNumberOfBlocks(), one->GetOutput()->GetNumberOfBlocks());
      ExpectSameArrays(rank->GetOutput()->GetFieldData(), one->GetOutput()->GetFieldData());
      vtkImageData* piece = Level(rank->GetOutput(), h);
      if (!piece)
      {
        continue;
      }
      EXPECT_EQ(Voxels(piece)->GetDataType(), Voxels(whole)->GetDataType());
      EXPECT_STREQ(Voxels(piece)->GetName(), Voxels(whole)->GetName());
      EXPECT_EQ(UnitOf(piece), UnitOf(whole));
      int place[3];
      double here[3];
      double there[3];
      int differences = 0;
      for (vtkIdType v = 0; v < piece->GetNumberOfPoints(); ++v)
      {
        piece->GetPoint(v, here);
        const int* size = piece->GetDimensions();
        const int* extent = piece->GetExtent();
        place[0] = extent[0] + static_cast<int>(v % size[0]);
        place[1] = extent[2] + static_cast<int>(v / size[0] % size[1]);
        place[2] = extent[4] + static_cast<int>(v / size[0] / size[1]);
        const vtkIdType inWhole = whole->ComputePointId(place);
        whole->GetPoint(inWhole, there);
        found[static_cast<std::size_t>(inWhole)] = 1;
        differences += Voxels(piece)->GetTuple1(v) != Voxels(whole)->GetTuple1(inWhole) ||
          !std::equal(here, here + 3, there);
      }
      EXPECT_EQ(differences, 0) << "level " << h;
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), 0), 0) << "level " << h;
  }
}
}

TEST(RankPyramid, IsInPiecesWithTheBitsOfOneRank)
{
  const Pyramids one = RunRanks(1);
  ASSERT_EQ(one[0]->GetOutput()->GetNumberOfBlocks(), 4u);
  for (const int count : { 2, 3, 12 })
  {
    SCOPED_TRACE(count);
    const Pyramids ranks = RunRanks(count);
    ExpectPiecesOf(one[0], ranks);
    EXPECT_LT(Level(ranks[0]->GetOutput(), 0)->GetNumberOfPoints(),
      0.7 * Level(one[0]->GetOutput(), 0)->GetNumberOfPoints());
  }
}

TEST(RankPyramid, MarksTheGhostsThatAreAskedFor)
{
  const Pyramids ranks = RunRanks(2, 1);
  ExpectPiecesOf(RunRanks(1)[0], ranks);
  for (const unsigned int h : { 0u, 1u })
  {
    vtkIdType own = 0;
    for (vtkImagePyramid* rank : ranks)
    {
      vtkImageData* piece = Level(rank->GetOutput(), h);
      vtkDataArray* ghosts = piece->GetCellData()->GetArray("vtkGhostType");
      ASSERT_TRUE(ghosts);
      for (vtkIdType c = 0; c < piece->GetNumberOfCells(); ++c)
      {
        own += ghosts->GetTuple1(c) == 0.0;
      }
    }
    EXPECT_EQ(own, Level(RunRanks(1)[0]->GetOutput(), h)->GetNumberOfCells());
  }
}

TEST(RankPyramid, ReportsTheErrorOfTheFirstOnAllAndWorksAgain)
{
  const Pyramids ranks = RunRanks(3, 0,
    [](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
    {
      pyramid->SetReductionFactor(7.0);
      const MessagesOf errors(pyramid);
      ThreadControllers::Update(pyramid, controller);
      EXPECT_TRUE(errors.Has("7")) << errors.Get();
      EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::UserError);
      EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
      pyramid->SetReductionFactor(std::sqrt(3.0));
    });
  ExpectPiecesOf(RunRanks(1)[0], ranks);
}

TEST(RankPyramid, IsThereAgainForRanksThatWereAskedForNothingInBetween)
{
  // As vtkCleanPolyData does it; the first rank is not asked again, and would not answer.
  const Pyramids ranks = RunRanks(3, 0,
    [](vtkImagePyramid* pyramid, vtkMultiProcessController* controller)
    {
      ThreadControllers::Update(pyramid, controller);
      if (controller->GetLocalProcessId() > 0)
      {
        pyramid->UpdatePiece(0, 0, 0);
        EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
      }
    });
  ExpectPiecesOf(RunRanks(1)[0], ranks);
}

TEST(RankPyramid, OtsuFindsTheThresholdOfTheWhole)
{
  vtkNew<vtkOtsuThreshold> one;
  one->SetInputData(SomeImage());
  one->Update();
  ThreadControllers::Run(3,
    [&](vtkMultiProcessController* controller)
    {
      vtkNew<PieceSource> source;
      source->Whole = SomeImage();
      vtkNew<vtkOtsuThreshold> otsu;
      otsu->SetController(controller);
      otsu->SetInputConnection(source->GetOutputPort());
      ThreadControllers::Update(otsu, controller);
      EXPECT_EQ(otsu->GetThreshold(), one->GetThreshold());
      EXPECT_EQ(
        otsu->GetHistogram()->GetNumberOfTuples(), one->GetHistogram()->GetNumberOfTuples());
      EXPECT_EQ(otsu->GetOutput()->GetNumberOfColumns(), 1);
      EXPECT_EQ(otsu->GetOutput()->GetNumberOfRows(), controller->GetLocalProcessId() == 0 ? 1 : 0);
      otsu->SetController(nullptr);
    });
}
