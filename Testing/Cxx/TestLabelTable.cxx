// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelImages.h"
#include "vtkLabelTable.h"
#include "vtkVolumeToSurface.h"

#include <vtkDoubleArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>

using namespace volumic;

namespace
{
using Extent = std::array<int, 6>;

Extent ExtentIn(vtkIntArray* extents, vtkIdType row)
{
  Extent extent;
  extents->GetTypedTuple(row, extent.data());
  return extent;
}

/** Return the warnings of vtkVolumeToSurface, which reports them at the end of the run. */
std::string WarningsOf(vtkVolumeToSurface* filter, vtkImageData* image)
{
  filter->SetInputData(image);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  const ProgressHook hook(filter,
    [&](vtkAlgorithm*, const std::string&, double share)
    { EXPECT_TRUE(share == 1.0 || warnings.Get().empty()); });
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0) << "it is made all the same";
  return warnings.Get();
}
}

TEST(LabelTable, ListsTheLabelsOfAnImage)
{
  const auto image = BallsImage();
  AddNames(image);
  image->GetFieldData()->RemoveArray("LabelColors");
  const auto table = Updated<vtkLabelTable>(image);
  vtkTable* labels = table->GetOutput();
  ASSERT_EQ(labels->GetNumberOfRows(), 3);
  EXPECT_EQ(labels->GetValueByName(0, "Label").ToInt(), 0);
  EXPECT_EQ(labels->GetValueByName(0, "Name").ToString(), "Label 0");
  EXPECT_EQ(labels->GetValueByName(2, "Label").ToInt(), 7);
  EXPECT_EQ(labels->GetValueByName(2, "Name").ToString(), "kidney");
  const double sum = labels->GetValueByName(0, "Voxels").ToDouble() +
    labels->GetValueByName(1, "Voxels").ToDouble() + labels->GetValueByName(2, "Voxels").ToDouble();
  EXPECT_EQ(sum, 34. * 28. * 28.);
  auto* extents = vtkIntArray::SafeDownCast(labels->GetColumnByName("Extent"));
  ASSERT_TRUE(extents);
  EXPECT_EQ(ExtentIn(extents, 0), (Extent{ 0, 33, 0, 27, 0, 27 }));
  EXPECT_EQ(ExtentIn(extents, 1), (Extent{ 4, 18, 7, 21, 7, 21 }));
  auto* colors = vtkDoubleArray::SafeDownCast(labels->GetColumnByName("Color"));
  ASSERT_TRUE(colors);
  EXPECT_EQ(colors->GetNumberOfComponents(), 3);
  EXPECT_NE(colors->GetComponent(1, 0), colors->GetComponent(2, 0)) << "a palette";
}

TEST(LabelTable, HasTheExtentsOfLabels)
{
  // Voxels across ends of rows, of slices and of the span of a thread.
  const int begins[3] = { -2, 5, 70 };
  const auto image = LabelImageOf(80, 70, 60,
    [](int i, int j, int k)
    {
      const int place = i + 80 * (j + 70 * k);
      return place == 81 || place == 325    ? 5
        : place >= 262100 && place < 262200 ? 6
        : i == 9 && j > 30 && j < 33        ? 7
                                            : 1;
    });
  image->SetExtent(begins[0], begins[0] + 79, begins[1], begins[1] + 69, begins[2], begins[2] + 59);
  const auto table = Updated<vtkLabelTable>(image);
  auto* extents = vtkIntArray::SafeDownCast(table->GetOutput()->GetColumnByName("Extent"));
  ASSERT_EQ(extents->GetNumberOfTuples(), 4);
  EXPECT_EQ(ExtentIn(extents, 0), (Extent{ -2, 77, 5, 74, 70, 129 }));
  EXPECT_EQ(ExtentIn(extents, 1), (Extent{ -1, 3, 6, 9, 70, 70 }));
  EXPECT_EQ(ExtentIn(extents, 2), (Extent{ -2, 77, 61, 62, 116, 116 }));
  EXPECT_EQ(ExtentIn(extents, 3), (Extent{ 7, 7, 36, 37, 70, 129 }));
}

TEST(LabelTable, ReportsImagesThatAreNotLabelMaps)
{
  vtkNew<vtkLabelTable> table;
  table->SetInputData(RandomImage(30, 30, 30));
  ExpectErrorOf(table, { "labels must be integers" });
  table->SetInputData(BallsImage());
  table->Update();
  EXPECT_EQ(table->GetOutput()->GetNumberOfRows(), 3);
}

TEST(LabelHint, VolumeToSurfaceWarnsOnce)
{
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT })
  {
    vtkNew<vtkVolumeToSurface> filter;
    filter->SetIsoValue(0.5);
    const std::string warnings = WarningsOf(filter, LabelImageOf(34, 28, 28, TwoBalls, type));
    EXPECT_TRUE(
      Has(warnings, "array 'Labels' looks like a label map: it has 3 different integers"));
    EXPECT_TRUE(Has(warnings, "Labels to Surfaces"));
    EXPECT_EQ(WarningsOf(filter, LabelImageOf(34, 28, 28, TwoBalls, type)), "") << "once";
  }
}

TEST(LabelHint, ScansAreNotLabelMaps)
{
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetIsoValue(50.);
  EXPECT_EQ(WarningsOf(filter, BallImage(30, 30, 30)), "");
  // Noise may have missed parts, with another warning.
  EXPECT_FALSE(Has(WarningsOf(filter, RandomImage(20, 20, 20, VTK_UNSIGNED_CHAR)), "label map"));
  // Integers of 8 bits that change from voxel to voxel.
  const auto soft = [](int i, int j, int k)
  { return std::floor(100. - 5. * std::hypot(i - 14., j - 14., k - 14.)); };
  EXPECT_EQ(WarningsOf(filter, LabelImageOf(28, 28, 28, soft, VTK_SIGNED_CHAR)), "");
}
