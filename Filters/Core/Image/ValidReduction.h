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
 * ReduceLevel where not all voxels have a value: an output voxel is the mean of those that do, by
 * the same weights, and NaN where they have less than half of the weight.
 *
 * @param valid 1 for voxels with a value, 0 for others, whose value does not matter
 */
template <typename T>
bool ReduceValidVoxels(const T* input, const LargeVector<std::uint8_t>& valid,
  const LevelGeometry& inputGeometry, typename RealOf<T>::Type* output,
  const LevelGeometry& outputGeometry, Executor& executor, const LevelProgress& progress);

/** 1 for numbers, 0 for NaN. */
template <typename Real>
LargeVector<std::uint8_t> MarkNumbers(const Real* values, std::int64_t n);
}

#endif
