// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"
#include "vtkOtsuThreshold.h"
#include "vtkVolumeToSurface.h"

#include <vtkDoubleArray.h>
#include <vtkTable.h>

using namespace volumic;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/** A row of voxels with these values. */
vtkSmartPointer<vtkImageData> RowOf(const std::vector<double>& values, int type = VTK_INT)
{
  return ImageOf(
    { static_cast<int>(values.size()), 1, 1 }, [&](int i, int, int) { return values[i]; }, type);
}

double ThresholdOf(vtkImageData* image)
{
  return Updated<vtkOtsuThreshold>(image)->GetThreshold();
}
}

TEST(OtsuThreshold, IsBetweenTheClassesAndNotAVoxelValue)
{
  EXPECT_EQ(ThresholdOf(RowOf({ 1, 2, 3, 11, 12, 13 }, VTK_DOUBLE)), 7.0);
  EXPECT_EQ(ThresholdOf(RowOf({ 0, 0, 1, 90, 91, 100 })), 45.5);
  EXPECT_EQ(ThresholdOf(RowOf({ -5, -4 })), -4.5);
  EXPECT_EQ(ThresholdOf(RowOf({ NaN, 1, NaN, 2, NaN }, VTK_DOUBLE)), 1.5);
  // The nearest two of three groups are one class.
  EXPECT_EQ(ThresholdOf(RowOf({ 0, 0, 10, 10, 60, 60 }, VTK_DOUBLE)), 35.0);
}

TEST(OtsuThreshold, HasAHistogram)
{
  const auto otsu = Updated<vtkOtsuThreshold>(RowOf({ 10, 10, 11, 90, 110, 110 }));
  EXPECT_EQ(otsu->GetOutput()->GetValueByName(0, "Threshold").ToDouble(), otsu->GetThreshold());
  vtkDoubleArray* histogram = otsu->GetHistogram();
  ASSERT_EQ(histogram->GetNumberOfTuples(), 2 + 1024);
  EXPECT_EQ(histogram->GetValue(0), 10.0);
  EXPECT_EQ(histogram->GetValue(1), 110.0);
  const double* counts = histogram->GetPointer(2);
  EXPECT_EQ(std::accumulate(counts, counts + 1024, 0.0), 6.0);
  EXPECT_EQ(counts[0], 2.0);
  EXPECT_EQ(counts[10], 1.0);
  EXPECT_EQ(counts[819], 1.0);
  EXPECT_EQ(counts[1023], 2.0);
  otsu->SetInputData(RowOf({ 3, 3 }));
  EXPECT_NE(MessagesOfUpdate(otsu), "");
  EXPECT_EQ(otsu->GetHistogram()->GetNumberOfTuples(), 0);
}

TEST(OtsuThreshold, HasASecondThresholdForASmallBrightPart)
{
  const auto brightOf = [](std::size_t dark, std::size_t medium, std::size_t bright)
  {
    std::vector<double> values(dark, 0);
    values.insert(values.end(), medium, 200);
    values.insert(values.end(), bright, 500);
    const auto otsu = Updated<vtkOtsuThreshold>(RowOf(values));
    EXPECT_EQ(otsu->GetThreshold(), 100.5);
    return otsu->GetBrightThreshold();
  };
  EXPECT_EQ(brightOf(50, 44, 6), 350.0);
  EXPECT_TRUE(std::isnan(brightOf(50, 39, 11))) << "not small";
  EXPECT_TRUE(std::isnan(brightOf(92, 7, 1))) << "the object is small already";
}

TEST(OtsuThreshold, ReportsInseparableVoxels)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& values :
    { std::vector<double>{ 3, 3, 3 }, { 1, infinity, 2 }, { NaN, NaN, NaN }, { 3, NaN, 3 } })
  {
    vtkNew<vtkOtsuThreshold> otsu;
    otsu->SetInputData(RowOf(values, VTK_DOUBLE));
    ExpectErrorOf(otsu, { "array 'Voxels'" });
    EXPECT_TRUE(std::isnan(otsu->GetThreshold()));
    EXPECT_EQ(otsu->GetOutput()->GetNumberOfColumns(), 0);
    otsu->SetInputData(RowOf({ 1, 2 }, VTK_DOUBLE));
    otsu->Update();
    EXPECT_EQ(otsu->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(otsu->GetOutput()->GetNumberOfRows(), 1);
  }
}

TEST(VolumeToSurface, IsIdenticalToPyramidAndSurface)
{
  const auto image = BallImage(40, 40, 40);
  const auto choose = [](auto* f)
  {
    f->SetNumberOfLevels(2);
    f->SetReductionFactor(1.5);
  };
  const auto filter = SurfaceOf<vtkVolumeToSurface>(image, choose);
  const auto pyramid = Updated<vtkImagePyramid>(image, choose);
  EXPECT_EQ(filter->GetLevels()->GetNumberOfBlocks(), 2u);
  EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), SurfaceOf(pyramid->GetOutput())->GetOutput()));
}

TEST(VolumeToSurface, UsesCellCentersAsVoxels)
{
  const auto image = BallImage(40, 40, 40);
  image->SetOrigin(3, -2, 100);
  image->SetSpacing(0.5, 0.5, 0.5);
  image->SetExtent(-7, 32, 4, 43, 0, 39);
  const auto ofPoints = Updated<vtkVolumeToSurface>(image);
  const auto cells = AsCells(image);
  const auto ofCells = Updated<vtkVolumeToSurface>(cells);
  ASSERT_GT(ofCells->GetOutput()->GetNumberOfPoints(), 100);
  EXPECT_TRUE(AreSameSurfaces(ofCells->GetOutput(), ofPoints->GetOutput()));

  // Selected cell data are used also if there are active point scalars.
  vtkNew<vtkDoubleArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(cells->GetNumberOfPoints());
  other->Fill(1.0);
  cells->GetPointData()->SetScalars(other);
  ofCells->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Voxels");
  ofCells->Update();
  EXPECT_TRUE(AreSameSurfaces(ofCells->GetOutput(), ofPoints->GetOutput()));
}

TEST(VolumeToSurface, ReportsWhyThereIsNoThreshold)
{
  const auto image = BallImage(20, 20, 20);
  Voxels(image)->Fill(4.0);
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetInputData(image);
  ExpectErrorOf(filter, { "Iso Value is not set, and cannot be computed", "ranges from 4 to 4" });
  filter->SetInputData(BallImage(20, 20, 20));
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
}
