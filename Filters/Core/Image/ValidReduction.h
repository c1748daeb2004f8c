// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicValidReduction_h
#define volumicValidReduction_h

#include "Core/Common/ScratchMemory.h"
#include "Core/Image/LevelReduction.h"

#include <cstdint>

namespace volumic
{
/**
 * ReduceLevel() for images with invalid voxels. An output voxel is the weighted mean of the valid
 * voxels, or NaN if their weight is below one half.
 *
 * @param valid 1 for valid voxels, 0 for others, whose value has no effect
 */
template <typename T>
bool ReduceValidVoxels(const T* input, const LargeVector<std::uint8_t>& valid,
  const LevelGeometry& inputGeometry, typename RealOf<T>::Type* output,
  const LevelGeometry& outputGeometry, Executor& executor, const ProgressCallback& progress);

/** Return 1 for numbers, 0 for NaN. */
template <typename Real>
LargeVector<std::uint8_t> MarkNumbers(const Real* values, std::int64_t n);
}

#endif
