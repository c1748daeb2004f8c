// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Pyramids and thresholds that several ranks ask for.

#include "RankTestTools.h"
#include "TestPrelude.h"
#include "vtkOtsuThreshold.h"

#include <vtkErrorCode.h>

#include <array>

using namespace volumic;

namespace
{
using Image = vtkSmartPointer<vtkImageData>;

/** Not at the origin, its extent begins elsewhere; with an array beside its voxels. */
Image TurnedImage()
{
  Image image = RandomImage(31, 26, 29, VTK_SHORT);
  image->SetExtent(5, 35, -3, 22, 7, 35);
  image->SetOrigin(1.0, 2.0, 3.0);
  image->SetSpacing(1.0, 1.25, 0.75);
  double quarter[9] = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
  image->SetDirectionMatrix(quarter);
  return image;
}

/** The pieces of a pyramid, after some were asked for nothing in between. */
std::vector<vtkSmartPointer<vtkImagePyramid>> PyramidsOf(int count)
{
  return OnRanks<vtkImagePyramid>(count, TurnedImage,
    [](vtkImagePyramid* pyramid, RankController* controller)
    {
      pyramid->SetNumberOfLevels(3);
      UpdatePiece(pyramid, controller, 1);
      if (controller->GetLocalProcessId() > 0)
      {
        // As vtkCleanPolyData does it; the first rank is not asked again, and would not answer.
        pyramid->UpdatePiece(0, 0, 0);
        EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
      }
      UpdatePiece(pyramid, controller, 1);
      EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::NoError);
    });
}
}

TEST(RankPyramid, IsInPiecesWithTheBitsOfOneRankAndGhosts)
{
  const auto one = PyramidsOf(1);
  for (const int count : { 2, 12 })
  {
    const auto ranks = PyramidsOf(count);
    for (unsigned int h = 0; h < 3; ++h)
    {
      SCOPED_TRACE(h);
      vtkImageData* whole = Level(one[0]->GetOutput(), h);
      vtkIdType cells = 0;
      for (vtkImagePyramid* rank : ranks)
      {
        ExpectSameArrays(rank->GetOutput()->GetFieldData(), one[0]->GetOutput()->GetFieldData());
        vtkImageData* piece = Level(rank->GetOutput(), h);
        EXPECT_TRUE(piece || count == 12);
        if (!piece)
        {
          continue;
        }
        vtkNew<vtkImageData> expected;
        expected->DeepCopy(whole);
        expected->Crop(piece->GetExtent());
        vtkNew<vtkPointData> voxels;
        voxels->ShallowCopy(piece->GetPointData());
        voxels->RemoveArray("vtkGhostType");
        ExpectSameArrays(expected->GetPointData(), voxels);
        EXPECT_EQ(UnitOf(piece), UnitOf(whole));
        for (const vtkIdType p : { vtkIdType(0), piece->GetNumberOfPoints() - 1 })
        {
          std::array<double, 3> here;
          std::array<double, 3> there;
          piece->GetPoint(p, here.data());
          expected->GetPoint(p, there.data());
          EXPECT_EQ(here, there);
        }
        for (vtkIdType c = 0; c < piece->GetNumberOfCells(); ++c)
        {
          cells += IsGhost(piece->GetCellData(), c) ? 0 : 1;
        }
        EXPECT_TRUE(piece->GetCellData()->HasArray("vtkGhostType"));
      }
      EXPECT_EQ(cells, whole->GetNumberOfCells());
    }
  }
}

TEST(RankPyramid, OtsuFindsTheThresholdOfTheWhole)
{
  vtkNew<vtkOtsuThreshold> one;
  one->SetInputData(TurnedImage());
  one->Update();
  volumic::RunRanks(3,
    [&](RankController* controller)
    {
      vtkNew<PieceSource> source;
      source->Whole = TurnedImage();
      vtkNew<vtkOtsuThreshold> otsu;
      otsu->SetController(controller);
      otsu->SetInputConnection(source->GetOutputPort());
      UpdatePiece(otsu, controller);
      EXPECT_EQ(otsu->GetThreshold(), one->GetThreshold());
      EXPECT_EQ(
        otsu->GetHistogram()->GetNumberOfTuples(), one->GetHistogram()->GetNumberOfTuples());
      EXPECT_EQ(otsu->GetOutput()->GetNumberOfColumns(), 1);
      EXPECT_EQ(otsu->GetOutput()->GetNumberOfRows(), controller->GetLocalProcessId() == 0 ? 1 : 0);
      otsu->SetController(nullptr);
    });
}
