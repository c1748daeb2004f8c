// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelReduction_h
#define volumicLevelReduction_h

#include "Core/Common/Executor.h"
#include "Core/Image/PyramidGeometry.h"
#include "Core/Image/RowKernels.h"

#include <cstdint>
#include <functional>

namespace volumic
{
/**
 * Told the share of a level that is done, in [0, 1]; false asks to stop. Called on the thread that
 * called the computation, never from within the executor.
 */
using LevelProgress = std::function<bool(double share)>;

/**
 * Level h+1 from level h: eq. 5, one banded operator per axis (AxisOperator).
 *
 * The axes are taken in the order z, y, x, but not one after the other over the whole level: each
 * thread makes a few rows at a time and needs work space for about twenty of them. Voxels are
 * x fastest. An output voxel is always made by the same operations in the same order, so that the
 * result does not depend on the executor.
 *
 * @param input          voxels of level h
 * @param inputGeometry  of it; the Unit of the level, U_h, is the offset of the kernel
 * @param output         room for the voxels of level h+1
 * @param outputGeometry of that
 * @return false if `progress` asked to stop before the end; the output is unfinished then.
 */
template <typename T>
bool ReduceLevel(const T* input, const LevelGeometry& inputGeometry,
  typename RealOf<T>::Type* output, const LevelGeometry& outputGeometry, Executor& executor,
  const LevelProgress& progress);

/** Voxels that are NaN or infinite. */
struct NotFiniteVoxels
{
  std::int64_t Count = 0;
  std::int64_t First = -1; ///< index of the first one, or -1
};

/** Counts voxels that are not finite; costs nothing for integer types. */
template <typename T>
NotFiniteVoxels FindNotFiniteVoxels(const T* values, std::int64_t n, Executor& executor);
}

#endif
