// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputImage.h"

#include "Core/Common/Refuse.h"
#include "Input/ImagePieces.h"
#include "Input/LevelPlaces.h"

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

#include <initializer_list>
#include <stdexcept>
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

/** How many blocks there are, if each is an image or none; else 0. */
int CountImageBlocks(vtkDataObject* input)
{
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input);
  const unsigned int count = blocks ? blocks->GetNumberOfBlocks() : 0;
  for (unsigned int h = 0; h < count; ++h)
  {
    if (blocks->GetBlock(h) && !vtkImageData::SafeDownCast(blocks->GetBlock(h)))
    {
      return 0;
    }
  }
  return static_cast<int>(count);
}

/** Whether there is nothing in it. */
bool IsNothing(vtkDataObject* input)
{
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    return image->GetNumberOfPoints() == 0;
  }
  auto* composite = vtkDataObjectTree::SafeDownCast(input);
  return !input || (composite && composite->GetNumberOfPoints() == 0);
}
}

bool ArePiecesOfLevels(Communicator& ranks, vtkDataObject* input)
{
  const int count = CountImageBlocks(input);
  const std::vector<int> counts = GatherValues(ranks, count);
  if (count < 2 || counts != std::vector<int>(counts.size(), count))
  {
    return false;
  }
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(input);
  std::vector<vtkSmartPointer<vtkImageData>> frames;
  try
  {
    for (int h = 0; h < count; ++h)
    {
      const ImagePieces pieces(
        ranks, vtkImageData::SafeDownCast(blocks->GetBlock(static_cast<unsigned int>(h))));
      if (pieces.IsEmpty())
      {
        return false;
      }
      frames.emplace_back(pieces.Frame());
    }
  }
  catch (const std::invalid_argument&)
  {
    return false; // All ranks are of the same opinion.
  }
  return AreLevels({ frames.begin(), frames.end() });
}

vtkImageData* PieceOfImage(Communicator& ranks, vtkDataObject* input)
{
  if (ArePiecesOfLevels(ranks, input))
  {
    return vtkImageData::SafeDownCast(vtkMultiBlockDataSet::SafeDownCast(input)->GetBlock(0));
  }
  return ranks.NumberOfRanks() > 1 && IsNothing(input) ? nullptr : ImageOf(input);
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
