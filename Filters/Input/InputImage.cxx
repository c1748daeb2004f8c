// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputImage.h"

#include "Core/Common/Refuse.h"
#include "Input/ImageVoxels.h"

#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

namespace volumic
{
namespace
{
/** All levels have the place of the first voxel, the direction and the real size of level 0. */
void CheckSizeAndOrigin(vtkImageData* level0, vtkImageData* image, unsigned int h)
{
  const int* extent0 = level0->GetExtent();
  const int* extent = image->GetExtent();
  double first0[3];
  double first[3];
  level0->TransformIndexToPhysicalPoint(extent0[0], extent0[2], extent0[4], first0);
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], first);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double real0 = level0->GetSpacing()[axis] * level0->GetDimensions()[axis];
    const double real = image->GetSpacing()[axis] * image->GetDimensions()[axis];
    const double tolerance = 1e-5 * std::abs(real0);
    if (std::abs(real - real0) > tolerance)
    {
      Refuse("block ", h, " is not a level of a pyramid: its real size along ", "xyz"[axis], " is ",
        real, ", that of block 0 is ", real0, ".", LevelsWayOut);
    }
    if (std::abs(first[axis] - first0[axis]) > tolerance)
    {
      Refuse("block ", h, " is not a level of a pyramid: its first voxel lies at ", first[axis],
        " along ", "xyz"[axis], ", that of block 0 at ", first0[axis], ".", LevelsWayOut);
    }
  }
  for (int i = 0; i < 9; ++i)
  {
    const double difference =
      image->GetDirectionMatrix()->GetData()[i] - level0->GetDirectionMatrix()->GetData()[i];
    if (std::abs(difference) > 1e-6)
    {
      Refuse("block ", h, " is not a level of a pyramid: its direction differs from block 0's.",
        LevelsWayOut);
    }
  }
}

void CheckShrinks(vtkImageData* below, vtkImageData* image, unsigned int h)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis of one voxel stays one while others shrink.
    const bool isDone = below->GetDimensions()[axis] == 1 && image->GetDimensions()[axis] == 1;
    if (!isDone && image->GetDimensions()[axis] >= below->GetDimensions()[axis])
    {
      Refuse("block ", h, " is not a level of a pyramid: it has ", SizeOf(image),
        " voxels, and block ", h - 1, " below it ", SizeOf(below), ".", LevelsWayOut);
    }
  }
}
}

void CheckPlace(vtkImageData* level0, vtkImageData* below, vtkImageData* image, unsigned int h)
{
  CheckSizeAndOrigin(level0, image, h);
  CheckShrinks(below, image, h);
}

namespace
{
/** Level 0 if the blocks are the levels of a pyramid (two at least), by size and place, else null.
 */
vtkImageData* Level0OfPyramid(vtkMultiBlockDataSet* blocks)
{
  std::vector<vtkImageData*> images;
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    images.push_back(vtkImageData::SafeDownCast(blocks->GetBlock(h)));
    if (!images[h] || images[h]->GetNumberOfPoints() == 0)
    {
      return nullptr;
    }
  }
  try
  {
    for (unsigned int h = 1; h < images.size(); ++h)
    {
      CheckPlace(images[0], images[h - 1], images[h], h);
    }
  }
  catch (const std::invalid_argument&)
  {
    return nullptr;
  }
  return images.size() > 1 ? images[0] : nullptr;
}

/** Whether the filter Resample To Image makes an image of it that shows the same. */
bool CanBeResampled(vtkDataObject* data)
{
  for (const char* type : { "vtkRectilinearGrid", "vtkStructuredGrid", "vtkUnstructuredGridBase",
         "vtkHyperTreeGrid", "vtkCompositeDataSet" })
  {
    if (data->IsA(type))
    {
      return true;
    }
  }
  return false;
}

[[noreturn]] void RefuseType(vtkDataObject* data)
{
  if (CanBeResampled(data))
  {
    Refuse("it is a ", data->GetClassName(),
      "; an image of evenly spaced voxels (vtkImageData) is "
      "needed. Apply Resample To Image (vtkResampleToImage) to it first.");
  }
  Refuse("it is a ", data->GetClassName(), "; an image (vtkImageData) is needed.");
}

vtkImageData* OnlyImageIn(vtkDataObjectTree* composite)
{
  std::vector<vtkDataObject*> leaves;
  std::vector<vtkImageData*> images;
  auto iterator = vtk::TakeSmartPointer(composite->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    leaves.push_back(iterator->GetCurrentDataObject());
    if (auto* image = vtkImageData::SafeDownCast(leaves.back()))
    {
      images.push_back(image);
    }
  }
  if (images.size() == 1)
  {
    return images[0];
  }
  if (images.size() > 1)
  {
    Refuse("the ", composite->GetClassName(), " has ", images.size(),
      " images, which are not the levels of a pyramid; one is needed. Take one of them by Extract "
      "Block, or make one image of them by Resample To Image (vtkResampleToImage).");
  }
  if (leaves.empty())
  {
    Refuse("the ", composite->GetClassName(), " is empty: there is no image in it.");
  }
  RefuseType(leaves.size() == 1 ? leaves[0] : composite);
}

/** The array of cells that is meant, if cells are. */
vtkDataArray* ChosenCells(vtkImageData* image, vtkInformation* selection)
{
  const std::string name = ChosenName(selection);
  if (!name.empty())
  {
    const bool areCells = selection->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
      selection->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    return areCells ? image->GetCellData()->GetArray(name.c_str()) : nullptr;
  }
  return image->GetPointData()->GetScalars() ? nullptr : image->GetCellData()->GetScalars();
}

/** Hides the points that stand for hidden cells. */
void BlankAsCells(vtkImageData* cells, vtkImageData* points)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    cells->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (!ghosts || ghosts->GetNumberOfTuples() != points->GetNumberOfPoints())
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> hidden;
  hidden->SetName(vtkDataSetAttributes::GhostArrayName());
  hidden->SetNumberOfTuples(ghosts->GetNumberOfTuples());
  std::transform(ghosts->GetPointer(0), ghosts->GetPointer(0) + ghosts->GetNumberOfTuples(),
    hidden->GetPointer(0),
    [](unsigned char ghost)
    {
      return static_cast<unsigned char>(
        ghost & vtkDataSetAttributes::HIDDENCELL ? vtkDataSetAttributes::HIDDENPOINT : 0);
    });
  points->GetPointData()->AddArray(hidden);
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
        Refuse("the source gives only ", SizeOf(image), " of the image's ",
          requested[1] - requested[0] + 1, " x ", requested[3] - requested[2] + 1, " x ",
          requested[5] - requested[4] + 1,
          " voxels, as one that is distributed over several processes does. The first process needs "
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
    Refuse("there is no image.");
  }
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    return image;
  }
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input))
  {
    if (vtkImageData* image = Level0OfPyramid(blocks))
    {
      return image;
    }
  }
  // Refined grids are one dataset, though they are a tree of images from VTK 9.6 on.
  auto* composite = vtkDataObjectTree::SafeDownCast(input);
  if (composite && !input->IsA("vtkUniformGridAMR"))
  {
    return OnlyImageIn(composite);
  }
  RefuseType(input);
}

PointVoxels TakeCellsAsPoints(vtkImageData* image, vtkInformation* selection)
{
  PointVoxels voxels;
  vtkDataArray* cells = image ? ChosenCells(image, selection) : nullptr;
  if (!cells)
  {
    voxels.Image = image;
    voxels.Selection = selection;
    return voxels;
  }
  voxels.Image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  double first[3];
  double centre[3];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis with one point has one cell.
    extent[2 * axis + 1] = std::max(extent[2 * axis], extent[2 * axis + 1] - 1);
    first[axis] = image->GetDimensions()[axis] > 1 ? 0.5 : 0.0;
  }
  image->TransformContinuousIndexToPhysicalPoint(first, centre);
  voxels.Image->SetExtent(extent);
  voxels.Image->SetOrigin(centre);
  voxels.Image->SetSpacing(image->GetSpacing());
  voxels.Image->SetDirectionMatrix(image->GetDirectionMatrix());
  voxels.Image->GetPointData()->SetScalars(cells);
  BlankAsCells(image, voxels.Image);
  voxels.Selection = vtkSmartPointer<vtkInformation>::New();
  voxels.Selection->Set(
    vtkDataObject::FIELD_ASSOCIATION(), vtkDataObject::FIELD_ASSOCIATION_POINTS);
  voxels.Selection->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
  return voxels;
}
}
