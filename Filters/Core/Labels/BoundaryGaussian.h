// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBoundaryGaussian_h
#define volumicBoundaryGaussian_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Labels/BoundaryRows.h"

#include <array>
#include <functional>
#include <vector>

namespace volumic
{
/** A Gaussian over the voxels about a boundary, one axis after another, cut off at 3 sigma. */
class BoundaryGaussian
{
public:
  /** Writes `count` values from voxel (i, j, k) on along x; any place, 0 outside the box. */
  using Source = std::function<void(int i, int j, int k, int count, float* values)>;

  /** @param sigma in voxels of each axis; 0: none. The rows must outlive it. */
  BoundaryGaussian(const BoundaryRows& rows, const std::array<double, 3>& sigma);

  /** @param result over the box of the rows; its other voxels are not written. */
  void Smooth(const Source& source, LargeVector<float>& result, Executor& executor);

private:
  void SmoothAlongX(const Source& source, Executor& executor);
  void SmoothAcross(int axis, const BoundaryRows& rows, const LargeVector<float>& from,
    LargeVector<float>& to, Executor& executor) const;

  const BoundaryRows* Rows;
  BoundaryRows BeforeZ; ///< what the pass along z reads
  BoundaryRows BeforeY; ///< what the pass along y reads
  std::array<std::vector<float>, 3> Weights; ///< from the middle on
  LargeVector<float> AlongX;
  LargeVector<float> AlongY;
};
}

#endif
