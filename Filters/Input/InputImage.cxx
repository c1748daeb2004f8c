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
  const auto refuse = [h](const auto&... parts)
  { ThrowInvalidArgument("block ", h, " is not a level of a pyramid: ", parts..., LevelsWayOut); };
  const Point first0 = FirstVoxelOf(level0);
  const Point first = FirstVoxelOf(image);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double real0 = level0->GetSpacing()[axis] * level0->GetDimensions()[axis];
    const double real = image->GetSpacing()[axis] * image->GetDimensions()[axis];
    const double tolerance = 1e-5 * std::abs(real0);
    if (std::abs(real - real0) > tolerance)
    {
      refuse(
        "its real size along ", "xyz"[axis], " is ", real, ", that of block 0 is ", real0, ".");
    }
    if (std::abs(first[axis] - first0[axis]) > tolerance)
    {
      refuse("its first voxel lies at ", first[axis], " along ", "xyz"[axis],
        ", that of block 0 at ", first0[axis], ".");
    }
    // An axis of one voxel stays one while others shrink.
    if (image->GetDimensions()[axis] >= std::max(below->GetDimensions()[axis], 2))
    {
      refuse(
        "it has ", SizeOf(image), " voxels, and block ", h - 1, " below it ", SizeOf(below), ".");
    }
  }
  const double* direction = image->GetDirectionMatrix()->GetData();
  if (!std::equal(direction, direction + 9, level0->GetDirectionMatrix()->GetData(),
        [](double a, double b) { return std::abs(a - b) <= 1e-6; }))
  {
    refuse("its direction differs from block 0's.");
  }
}

namespace
{
/** Whether images are the levels of a pyramid, by size and place. */
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
  const bool isField = !data->IsA("vtkPolyData") && !data->IsA("vtkTable");
  ThrowInvalidArgument("it is a ", data->GetClassName(),
    "; an image of evenly spaced voxels (vtkImageData) is needed.",
    isField ? " Apply Resample To Image (vtkResampleToImage) to it first." : "");
}

/** The only image, or level 0 of a pyramid. */
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
      " images, which are not the levels of a pyramid; one is needed. Take one of them by Extract "
      "Block, or make one image of them by Resample To Image (vtkResampleToImage).");
  }
  if (leaves.empty())
  {
    ThrowInvalidArgument("the ", composite->GetClassName(), " is empty: there is no image in it.");
  }
  ThrowInvalidType(leaves.size() == 1 ? leaves[0] : composite);
}

/** The array of cells that is meant, if cells are. */
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

/** Hides the points that stand for hidden cells. */
void BlankAsCells(vtkImageData* cells, vtkImageData* points)
{
  if (vtkUnsignedCharArray* ghosts = cells->GetCellGhostArray())
  {
    vtkNew<vtkUnsignedCharArray> hidden;
    hidden->SetName(vtkDataSetAttributes::GhostArrayName());
    for (vtkIdType cell = 0; cell < ghosts->GetNumberOfTuples(); ++cell)
    {
      const bool isHidden = (ghosts->GetValue(cell) & vtkDataSetAttributes::HIDDENCELL) != 0;
      hidden->InsertNextValue(isHidden ? vtkDataSetAttributes::HIDDENPOINT : 0);
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
        ThrowInvalidArgument("the source gives only ", SizeOf(image), " of the image's ",
          requested[1] - requested[0] + 1, " x ", requested[3] - requested[2] + 1, " x ",
          requested[5] - requested[4] + 1,
          " voxels, as one that is distributed over several processes does. The first process "
          "needs "
          "the whole image. Save it as .pvti, and open that file instead.");
      }
    }
  }
  return vtkDataObject::GetData(info);
}

vtkImageData* ImageOf(vtkDataObject* input)
{
  if (!input)
  {
    ThrowInvalidArgument("there is no image.");
  }
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    return image;
  }
  // Refined grids are one dataset, though they are a tree of images from VTK 9.6 on.
  auto* composite = vtkDataObjectTree::SafeDownCast(input);
  if (composite && !input->IsA("vtkUniformGridAMR"))
  {
    return ImageIn(composite);
  }
  ThrowInvalidType(input);
}

PointVoxels TakeCellsAsPoints(vtkImageData* image, vtkInformation* selection)
{
  vtkDataArray* cells = ChosenCells(image, selection);
  if (!cells)
  {
    return { image, selection };
  }
  int extent[6];
  double first[3];
  double centre[3];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis with one point has one cell.
    const bool isFlat = image->GetDimensions()[axis] == 1;
    extent[2 * axis + 1] -= isFlat ? 0 : 1;
    first[axis] = isFlat ? 0.0 : 0.5;
  }
  image->TransformContinuousIndexToPhysicalPoint(first, centre);
  auto points = vtkSmartPointer<vtkImageData>::New();
  points->SetExtent(extent);
  points->SetOrigin(centre);
  points->SetSpacing(image->GetSpacing());
  points->SetDirectionMatrix(image->GetDirectionMatrix());
  points->GetPointData()->SetScalars(cells);
  BlankAsCells(image, points);
  return { points, vtkSmartPointer<vtkInformation>::New() };
}
}
