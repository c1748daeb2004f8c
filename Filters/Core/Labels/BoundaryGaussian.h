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
/** A Gaussian at some voxels of a box, one axis after another, cut off at 3 sigma. */
class BoundaryGaussian
{
public:
  /** Writes `count` values from voxel (i, j, k) on along x, all of them within the box. */
  using Source = std::function<void(int i, int j, int k, int count, float* values)>;
  /** Gets the smoothed values of a run of voxels. */
  using Receiver = std::function<void(int i, int j, int k, int count, const float* values)>;

  /**
   * Smooth a source that is 0 outside the box; runs of a layer along z are received on one thread.
   * @param rows    whole groups of four voxels along x, as the length of their box
   * @param varying elsewhere each voxel has the value of the next one along x
   * @param sigma   in voxels of each axis
   */
  void Smooth(const VoxelBits& rows, const VoxelBits& varying, const std::array<double, 3>& sigma,
    const Source& source, const Receiver& receive, Executor& executor);

private:
  LargeVector<float> AlongXY; ///< a member, as its memory is used again
};
}

#endif
