// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NotFiniteVoxels.h"

#include "Core/Join.h"
#include "Core/LevelReduction.h"
#include "ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>

#include <cstdint>

namespace volumic
{
std::string DescribeNotFiniteVoxels(
  vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image, Executor& executor)
{
  NotFiniteVoxels found;
  switch (contiguous->GetDataType())
  {
    vtkTemplateMacro(
      found = FindNotFiniteVoxels(static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0)),
        image->GetNumberOfPoints(), executor));
    default:
      break;
  }
  if (found.Count == 0)
  {
    return "";
  }
  const int* extent = image->GetExtent();
  const int* size = image->GetDimensions();
  const std::int64_t row = found.First / size[0];
  return Join(NameOf(original), " has ", found.Count, " NaN or infinite voxel",
    found.Count == 1 ? "" : "s", ", the first at (", extent[0] + found.First % size[0], ", ",
    extent[2] + row % size[1], ", ", extent[4] + row / size[1],
    "). Replace them by numbers, for instance by the value of the background.");
}

}
