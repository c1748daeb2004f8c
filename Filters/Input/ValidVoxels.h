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
/** The valid voxels of an image, which are neither NaN nor blanked. The others are background. */
struct ValidVoxels
{
  LargeVector<std::uint8_t> Marks; ///< 1 or 0 per voxel; empty if all are valid
  std::int64_t NaNs = 0;           ///< number of NaN voxels that are not blanked
  std::int64_t FirstNaN = -1;      ///< index of the first one, or -1

  bool Has(std::int64_t voxel) const { return this->Marks.empty() || this->Marks[voxel] != 0; }
};

/**
 * Find the valid voxels. Blanked voxels are points that are hidden by the ghost array, or whose
 * cells are all hidden. Duplicate points are not blanked.
 * @param original   the array of the input, for messages
 * @param contiguous the same values contiguous in memory (ContiguousVoxels)
 * @throws InvalidArgument if voxels are infinite, or NaN without nanIsBackground
 */
ValidVoxels FindValidVoxels(vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image,
  bool nanIsBackground, Executor& executor);

/** Return the smallest and the largest valid voxel, in reverse order if none is valid. */
std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid);

/** @throws InvalidArgument if no voxel is valid */
void CheckAnyIsValid(vtkDataArray* original, const ValidVoxels& valid);

/** Return "array 'v' has 3 NaN voxels (1.5 %), the first at (i, j, k), which are background". */
std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid);
}

#endif
