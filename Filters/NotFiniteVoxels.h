// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef NotFiniteVoxels_h
#define NotFiniteVoxels_h

#include "Core/Executor.h"

#include <string>

class vtkDataArray;
class vtkImageData;

namespace volumic
{
/**
 * `array 'name' has 3 NaN or infinite voxels, the first at (i, j, k). …`, or nothing if all voxels
 * are finite.
 * @param original   the array as the user knows it
 * @param contiguous the same values in one block of memory (ContiguousVoxels)
 */
std::string DescribeNotFiniteVoxels(
  vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image, Executor& executor);
}

#endif
