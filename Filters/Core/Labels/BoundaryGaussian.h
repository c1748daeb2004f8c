// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBoundaryGaussian_h
#define volumicBoundaryGaussian_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Labels/VoxelBits.h"

#include <array>
#include <functional>

namespace volumic
{
/** Separable Gaussian filter for selected voxels of a box, truncated at 3 sigma. */
class BoundaryGaussian
{
public:
  /** Write `count` input values along x, starting at voxel (i, j, k). All are within the box. */
  using Source = std::function<void(int i, int j, int k, int count, float* values)>;
  /** Receive the smoothed values of a run of voxels along x. */
  using Receiver = std::function<void(int i, int j, int k, int count, const float* values)>;

  /**
   * Smooth a source that is 0 outside the box. All runs of a slice are received on one thread.
   * @param rows    voxels to compute, in whole groups of four along x. The box has a multiple of
   *                four voxels along x.
   * @param varying voxels whose value may differ from the next one along x
   * @param sigma   standard deviation along each axis, in voxels
   */
  void Smooth(const VoxelBits& rows, const VoxelBits& varying, const std::array<double, 3>& sigma,
    const Source& source, const Receiver& receive, Executor& executor);

private:
  LargeVector<float> AlongXY; ///< smoothed along x and y; a member, so that its memory is reused
};
}

#endif
