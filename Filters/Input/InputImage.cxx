// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputImage.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Input/ImageVoxels.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace volumic
{
void CheckGeometry(vtkImageData* level0, vtkImageData* below, vtkImageData* image, unsigned int h)
{
  const auto fail = [h](const auto&... parts)
  { ThrowInvalidArgument("block ", h, " is not a level of a pyramid: ", parts..., LevelsAdvice); };
  const Point first0 = FirstVoxelOf(level0);
  const Point first = FirstVoxelOf(image);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length0 = level0->GetSpacing()[axis] * level0->GetDimensions()[axis];
    const double length = image->GetSpacing()[axis] * image->GetDimensions()[axis];
    const double tolerance = 1e-5 * std::abs(length0);
    if (std::abs(length - length0) > tolerance)
    {
      fail("its length along ", "xyz"[axis], " is ", length, ", but the length of block 0 is ",
        length0, ".");
    }
    if (std::abs(first[axis] - first0[axis]) > tolerance)
    {
      fail("its first voxel is at ", first[axis], " along ", "xyz"[axis],
        ", but the first voxel of block 0 is at ", first0[axis], ".");
    }
    // Axes of one voxel are not reduced.
    if (image->GetDimensions()[axis] >= std::max(below->GetDimensions()[axis], 2))
    {
      fail("it has ", SizeOf(image), " voxels, not fewer than block ", h - 1, " with ",
        SizeOf(below), ".");
    }
  }
  const double* direction = image->GetDirectionMatrix()->GetData();
  if (!std::equal(direction, direction + 9, level0->GetDirectionMatrix()->GetData(),
        [](double a, double b) { return std::abs(a - b) <= 1e-6; }))
  {
    fail("its direction matrix differs from block 0.");
  }
}

namespace
{
/** Return whether images have the sizes and positions of the levels of a pyramid. */
bool AreLevels(const std::vector<vtkImageData*>& images)
{
  try
  {
    for (unsigned int h = 1; h < images.size(); ++h)
    {
      CheckGeometry(images[0], images[h - 1], images[h], h);
    }
  }
  catch (const InvalidArgument&)
  {
    return false;
  }
  return true;
}

[[noreturn]] void ThrowInvalidType(vtkDataObject* data)
{
  ThrowInvalidArgument("the input is a ", data->GetClassName(), ", not an image (vtkImageData). ",
    !data->IsA("vtkPolyData") && !data->IsA("vtkTable")
      ? "Apply Resample To Image (vtkResampleToImage) first."
      : "Connect an image.");
}

/** Return the only image, or level 0 of a pyramid. */
vtkImageData* ImageIn(vtkDataObjectTree* composite)
{
  const auto leaves = vtkCompositeDataSet::GetDataSets<vtkDataObject>(composite);
  const auto images = vtkCompositeDataSet::GetDataSets<vtkImageData>(composite);
  const bool isPyramid = images.size() == leaves.size() && AreLevels(images);
  if (images.size() == 1 || (images.size() > 1 && isPyramid))
  {
    return images[0];
  }
  if (images.size() > 1)
  {
    ThrowInvalidArgument("the ", composite->GetClassName(), " has ", images.size(),
      " images, which are not the levels of a pyramid. Select one by Extract Block, or join them "
      "by Resample To Image (vtkResampleToImage).");
  }
  if (leaves.empty())
  {
    ThrowInvalidArgument("the ", composite->GetClassName(), " has no image. Connect an image.");
  }
  ThrowInvalidType(leaves.size() == 1 ? leaves[0] : composite);
}

/** Return the selected cell array, or null if the selected array is not cell data. */
vtkDataArray* ChosenCells(vtkImageData* image, vtkInformation* selection)
{
  const std::string name = ChosenName(selection);
  if (name.empty())
  {
    return image->GetPointData()->GetScalars() ? nullptr : image->GetCellData()->GetScalars();
  }
  return selection->Get(vtkDataObject::FIELD_ASSOCIATION()) ==
      vtkDataObject::FIELD_ASSOCIATION_CELLS
    ? image->GetCellData()->GetArray(name.c_str())
    : nullptr;
}

void BlankAsCells(vtkImageData* cells, vtkImageData* points)
{
  if (vtkUnsignedCharArray* ghosts = cells->GetCellGhostArray())
  {
    vtkNew<vtkUnsignedCharArray> hidden;
    hidden->SetName(vtkDataSetAttributes::GhostArrayName());
    for (vtkIdType cell = 0; cell < ghosts->GetNumberOfTuples(); ++cell)
    {
      hidden->InsertNextValue(ghosts->GetValue(cell) & vtkDataSetAttributes::HIDDENCELL
          ? vtkDataSetAttributes::HIDDENPOINT
          : 0);
    }
    points->GetPointData()->AddArray(hidden);
  }
}
}

vtkDataObject* WholeInput(vtkInformationVector* port)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* info = port->GetInformationObject(0);
  auto* image = vtkImageData::GetData(info);
  if (image && image->GetNumberOfPoints() > 0 && info->Has(Pipeline::UPDATE_EXTENT()))
  {
    int requested[6];
    info->Get(Pipeline::UPDATE_EXTENT(), requested);
    const int* given = image->GetExtent();
    for (int axis = 0; axis < 3; ++axis)
    {
      if (given[2 * axis] > requested[2 * axis] || given[2 * axis + 1] < requested[2 * axis + 1])
      {
        ThrowInvalidArgument("the source provides only ", SizeOf(image), " of the image's ",
          requested[1] - requested[0] + 1, " x ", requested[3] - requested[2] + 1, " x ",
          requested[5] - requested[4] + 1,
          " voxels, but the first process needs the whole image. Save the distributed image as "
          ".pvti, and open that file.");
      }
    }
  }
  return vtkDataObject::GetData(info);
}

vtkImageData* ImageOf(vtkDataObject* input)
{
  if (!input)
  {
    ThrowInvalidArgument("there is no image. Connect one.");
  }
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    return image;
  }
  // From VTK 9.6 on AMR datasets are trees of images, too.
  auto* composite = vtkDataObjectTree::SafeDownCast(input);
  if (composite && !input->IsA("vtkUniformGridAMR"))
  {
    return ImageIn(composite);
  }
  ThrowInvalidType(input);
}

PointVoxels ConvertCellsToPoints(vtkImageData* image, vtkInformation* selection)
{
  vtkDataArray* cells = ChosenCells(image, selection);
  if (!cells)
  {
    return { image, selection };
  }
  int extent[6];
  double first[3];
  double center[3];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool isFlat = image->GetDimensions()[axis] == 1;
    extent[2 * axis + 1] -= isFlat ? 0 : 1;
    first[axis] = isFlat ? 0.0 : 0.5;
  }
  image->TransformContinuousIndexToPhysicalPoint(first, center);
  auto points = vtkSmartPointer<vtkImageData>::New();
  points->SetExtent(extent);
  points->SetOrigin(center);
  points->SetSpacing(image->GetSpacing());
  points->SetDirectionMatrix(image->GetDirectionMatrix());
  points->GetPointData()->SetScalars(cells);
  BlankAsCells(image, points);
  return { points, vtkSmartPointer<vtkInformation>::New() };
}
}
