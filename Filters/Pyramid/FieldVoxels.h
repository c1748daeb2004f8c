// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFieldVoxels_h
#define volumicFieldVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/ThickPart.h"
#include "Core/Image/VoxelValues.h"
#include "Input/ValidVoxels.h"

#include <array>
#include <cstdint>

class vtkDataArray;

namespace volumic
{
/** The voxels of a level as the surface reads them: Values and Base of LevelImage. */
struct FieldVoxels
{
  VoxelValues Values;
  double Base = 0.0;
};

/**
 * Floats are taken as they are, unless their differences are small beside their size; of all others
 * `base` is subtracted.
 * @param voxels contiguous in memory; they are shared
 * @param range  smallest and largest of all voxels of the level that are valid
 * @throws std::invalid_argument if their type is not supported.
 */
FieldVoxels FieldVoxelsOf(
  vtkDataArray* voxels, const std::array<double, 2>& range, double base);

/** What voxels get that are not valid: as far from the iso-value as any voxel is (Field.h). */
double BackgroundOf(const std::array<double, 2>& range, const SurfaceOptions& options);

/**
 * 64 bits that tell voxels apart (VoxelHash.h), as they came and by their type.
 * @param voxels contiguous in memory
 * @param size   how many there are along each axis
 */
std::uint64_t HashOfVoxels(
  vtkDataArray* voxels, const std::array<int, 3>& size, Executor& executor);

/**
 * Whether a part of the object, which is above the value (bright) or below, is at least that large
 * (ThickPart.h); also where their type is not supported.
 * @param size how many voxels there are along each axis
 */
bool HavePart(vtkDataArray* voxels, const std::array<int, 3>& size, const ValidVoxels& valid,
  const PartSize& least, double isoValue, bool objectIsBright);

/** Copies the values to `filled`, with the background for those that are not marked as valid. */
void FillInvalid(const FieldVoxels& voxels, const LargeVector<std::uint8_t>& marks,
  double background, float* filled, Executor& executor);
}

#endif
