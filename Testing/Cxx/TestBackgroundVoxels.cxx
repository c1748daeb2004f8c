// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"
#include "vtkVolumeToSurface.h"

#include <vtkDataSetAttributes.h>
#include <vtkUnsignedCharArray.h>

using namespace volumic;

namespace
{
constexpr int Size = 40;
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

using Where = std::function<bool(int i, int j, int k)>;

/** Return whether a voxel is outside a circle around the z axis, as the field of view of a CT. */
bool OutsideView(int i, int j, int)
{
  return std::hypot(i - BallCentre[0], j - BallCentre[1]) > 17.0;
}

/** Half of the ball. */
bool Right(int i, int, int)
{
  return i >= 20;
}

void ForEach(const Where& where, const std::function<void(vtkIdType)>& use)
{
  vtkIdType voxel = 0;
  ForVoxels({ Size, Size, Size },
    [&](int i, int j, int k)
    {
      if (where(i, j, k))
      {
        use(voxel);
      }
      ++voxel;
    });
}

vtkSmartPointer<vtkImageData> BallWith(double value, const Where& where)
{
  const auto image = BallImage(Size, Size, Size);
  ForEach(where, [&](vtkIdType voxel) { Voxels(image)->SetComponent(voxel, 0, value); });
  return image;
}

vtkUnsignedCharArray* AddGhosts(vtkDataSetAttributes* attributes, vtkIdType count)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(count);
  ghosts->Fill(0);
  attributes->AddArray(ghosts);
  return ghosts;
}

vtkSmartPointer<vtkImageData> BallBlanked(const Where& where, unsigned char ghost)
{
  const auto image = BallImage(Size, Size, Size);
  vtkUnsignedCharArray* ghosts = AddGhosts(image->GetPointData(), image->GetNumberOfPoints());
  ForEach(where, [&](vtkIdType voxel) { ghosts->SetValue(voxel, ghost); });
  return image;
}

/** A filter that does not print its warnings. */
struct QuietSurface
{
  vtkNew<vtkVolumeToSurface> Filter;
  MessagesOf Warnings{ this->Filter, vtkCommand::WarningEvent };

  vtkPolyData* Of(vtkDataObject* input)
  {
    this->Filter->SetInputDataObject(input);
    this->Filter->SetIsoValue(50.0);
    this->Filter->Update();
    return this->Filter->GetOutput();
  }
};
}

TEST(NaNVoxels, OutsideTheFieldOfViewHaveNoEffect)
{
  const auto image = BallWith(NaN, OutsideView);
  for (const int initialization : { vtkDeformableSurface::EnclosingIcosahedron,
         vtkDeformableSurface::Seeds, vtkDeformableSurface::IsoSurface })
  {
    QuietSurface surface;
    surface.Filter->SetInitialization(initialization);
    ExpectSphere(surface.Of(image), BallCentre, BallRadius, 0.5);
    EXPECT_EQ(StopReason(surface.Filter->GetOutput()), "converged");
  }
}

TEST(NaNVoxels, CutTheObjectAndAreReportedOnceWithTheirNumber)
{
  const auto image = BallWith(NaN, Right);
  QuietSurface surface;
  vtkPolyData* half = surface.Of(image);
  ASSERT_GT(half->GetNumberOfPoints(), 500);
  EXPECT_NEAR(EnclosedVolume(half), 0.5 * VolumeOfBall(BallRadius), 120.0);
  EXPECT_NEAR(half->GetBounds()[0], BallCentre[0] - BallRadius, 0.5);
  EXPECT_LT(half->GetBounds()[1], 20.0);
  EXPECT_GT(half->GetBounds()[1], 19.0);
  const std::string warning = surface.Warnings.Get();
  EXPECT_EQ(CountOf(warning, "NaN voxels"), 1) << warning;
  EXPECT_TRUE(Has(warning, "array 'Voxels' has 32000 NaN voxels (50 %), the first at (20, 0, 0)"));

  // vtkImagePyramid reports them. For other pyramids vtkDeformableSurface does.
  vtkNew<vtkImagePyramid> pyramid;
  const MessagesOf warnings(pyramid, vtkCommand::WarningEvent);
  pyramid->SetInputData(image);
  pyramid->Update();
  EXPECT_EQ(CountOf(warnings.Get(), "32000 NaN voxels"), 1) << warnings.Get();
  EXPECT_EQ(pyramid->GetOutput()->GetFieldData()->GetArray("NaNVoxels")->GetComponent(0, 0), 32000);
  for (const bool isByHand : { false, true })
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->ShallowCopy(pyramid->GetOutput());
    if (isByHand)
    {
      blocks->GetFieldData()->RemoveArray("NaNVoxels");
    }
    const auto filter = FilterOf(blocks);
    const std::string said = MessagesOfUpdate(filter, vtkCommand::WarningEvent);
    EXPECT_EQ(CountOf(said, "32000 NaN voxels"), isByHand ? 1 : 0) << said;
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 100);
  }
}

TEST(BlankedVoxels, AreBackgroundWithoutAWarning)
{
  // Hidden points, points whose cells are all hidden, and hidden cells as voxels.
  const auto amongCells = BallImage(Size, Size, Size);
  vtkUnsignedCharArray* hidden =
    AddGhosts(amongCells->GetCellData(), amongCells->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < amongCells->GetNumberOfCells(); ++cell)
  {
    // The points at 20 are corners of the visible cells at 19.
    hidden->SetValue(cell, cell % (Size - 1) >= 19 ? vtkDataSetAttributes::HIDDENCELL : 0);
  }
  const auto cells = AsCells(BallImage(Size, Size, Size));
  vtkUnsignedCharArray* ghosts = AddGhosts(cells->GetCellData(), cells->GetNumberOfCells());
  ForEach(
    Right, [&](vtkIdType voxel) { ghosts->SetValue(voxel, vtkDataSetAttributes::HIDDENCELL); });
  QuietSurface requested;
  ASSERT_GT(requested.Of(BallWith(NaN, Right))->GetNumberOfPoints(), 100);
  for (const auto& image :
    { BallBlanked(Right, vtkDataSetAttributes::HIDDENPOINT), amongCells, cells })
  {
    QuietSurface surface;
    surface.Filter->SetNumberOfThreads(2);
    EXPECT_TRUE(AreSameSurfaces(surface.Of(image), requested.Filter->GetOutput()));
    EXPECT_EQ(surface.Warnings.Get(), "");
  }
  // Duplicates are not blanked.
  QuietSurface surface;
  ExpectSphere(surface.Of(BallBlanked(Right, vtkDataSetAttributes::DUPLICATEPOINT)), BallCentre,
    BallRadius, 0.2);
}
