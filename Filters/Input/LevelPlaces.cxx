// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/LevelPlaces.h"

#include "Core/Common/Refuse.h"
#include "Input/ImageVoxels.h"

#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>

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

bool AreLevels(const std::vector<vtkImageData*>& images)
{
  try
  {
    for (std::size_t h = 1; h < images.size(); ++h)
    {
      CheckPlace(images[0], images[h - 1], images[h], static_cast<unsigned int>(h));
    }
  }
  catch (const std::invalid_argument&)
  {
    return false;
  }
  return images.size() > 1;
}

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
  return AreLevels(images) ? images[0] : nullptr;
}
}
