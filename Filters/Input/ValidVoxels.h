// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicValidVoxels_h
#define volumicValidVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"

#include <array>
#include <cstdint>
#include <string>

class vtkDataArray;
class vtkImageData;

namespace volumic
{
/** Which voxels of an image have a value: neither NaN nor blanked. The others are background. */
struct ValidVoxels
{
  LargeVector<std::uint8_t> Marks; ///< 1 or 0 per voxel; empty where all have a value
  std::int64_t NaNs = 0;           ///< among those that are not blanked
  std::int64_t FirstNaN = -1;      ///< its number in the image, or -1

  bool Has(std::int64_t voxel) const { return this->Marks.empty() || this->Marks[voxel] != 0; }
};

/**
 * Looks at all voxels. Blanked are points that the image's ghost array hides, and those whose cells
 * are all hidden; duplicates are none of them.
 * @param original   the array as the user knows it
 * @param contiguous the same values contiguous in memory (ContiguousVoxels)
 * @throws std::invalid_argument naming the array and the first of them where voxels are infinite,
 *         or NaN without nanIsBackground.
 */
ValidVoxels FindValidVoxels(vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image,
  bool nanIsBackground, Executor& executor);

/** The smallest and the largest voxel that is valid; the first is the larger one if none is. */
std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid);

/** @throws std::invalid_argument if no voxel is valid. */
void CheckAnyIsValid(vtkDataArray* original, const ValidVoxels& valid);

/** Return "array 'v' has 3 NaN voxels (1.5 %), the first at (i, j, k), which are background". */
std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid);
}

#endif
