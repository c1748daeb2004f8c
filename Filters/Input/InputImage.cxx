// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputImage.h"

#include "Core/Common/Refuse.h"
#include "Input/LevelPlaces.h"

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace volumic
{
namespace
{
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
    Refuse("it is a ", data->GetClassName(), "; an image of evenly spaced voxels (vtkImageData) is "
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
}
