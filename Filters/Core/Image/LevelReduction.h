// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelReduction_h
#define volumicLevelReduction_h

#include "Core/Common/Executor.h"
#include "Core/Common/Monitor.h"
#include "Core/Image/PyramidGeometry.h"
#include "Core/Image/RowKernels.h"

#include <cstdint>

namespace volumic
{
/**
 * Compute level h+1 from level h (eq. 5), with one banded operator per axis (AxisOperator).
 *
 * Each thread computes a few output rows at a time, in the order z, y, x, with buffers for about
 * twenty rows. Voxels are x fastest. The result does not depend on the executor.
 *
 * @param input          voxels of level h
 * @param inputGeometry  of level h; its Unit U_h is the distance between kernel positions
 * @param output         memory for the voxels of level h+1
 * @param outputGeometry of level h+1
 * @return false if `progress` cancelled the computation; the output is incomplete then
 */
template <typename T>
bool ReduceLevel(const T* input, const LevelGeometry& inputGeometry,
  typename RealOf<T>::Type* output, const LevelGeometry& outputGeometry, Executor& executor,
  const ProgressCallback& progress);

/** NaN and infinite voxels. */
struct NotFiniteVoxels
{
  std::int64_t Count = 0;
  std::int64_t First = -1; ///< index of the first one, or -1
};

/** Count NaN and infinite voxels. */
template <typename T>
NotFiniteVoxels FindNotFiniteVoxels(const T* values, std::int64_t n, Executor& executor);
}

#endif
