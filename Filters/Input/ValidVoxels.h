// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicValidVoxels_h
#define volumicValidVoxels_h

#include "Core/Common/Communicator.h"
#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"

#include <array>
#include <cstdint>
#include <string>

class vtkDataArray;
class vtkImageData;

namespace volumic
{
class ImagePieces;

/** Which voxels of an image have a value: neither NaN nor blanked. The others are background. */
struct ValidVoxels
{
  LargeVector<std::uint8_t> Marks; ///< 1 or 0 per voxel of the piece; empty where all have a value
  bool AreAll = true;              ///< whether all voxels of all ranks have one
  std::int64_t NaNs = 0;           ///< of all ranks, among those that are not blanked
  std::int64_t FirstNaN = -1;      ///< its number in the whole image, or -1

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

/**
 * The same by all ranks together, of an image that they hold in pieces: what is refused, all of
 * them refuse.
 * @param contiguous of this rank's piece; without tuples where it has none
 * @param image      the piece; null: none
 */
ValidVoxels FindValidVoxels(Communicator& ranks, const ImagePieces& pieces, vtkDataArray* original,
  vtkDataArray* contiguous, vtkImageData* image, bool nanIsBackground, Executor& executor);

/**
 * The smallest and the largest voxel that is valid; the first is the larger one if none is.
 * @param contiguous null: there are none
 */
std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid);

/** By all ranks together: of all of their pieces. */
std::array<double, 2> RangeOf(
  Communicator& ranks, vtkDataArray* contiguous, const ValidVoxels& valid);

/** @throws std::invalid_argument if no voxel is valid, of all ranks together. */
void CheckAnyIsValid(
  vtkDataArray* original, const ValidVoxels& valid, Communicator& ranks = OnThisRank());

/** `array 'name' has 3 NaN voxels (1.5 %), the first at (i, j, k), which are background.` */
std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid);
}

#endif
