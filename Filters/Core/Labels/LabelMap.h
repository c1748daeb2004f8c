// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelMap_h
#define volumicLabelMap_h

#include "Core/Common/ScratchMemory.h"
#include "Core/Image/VoxelBox.h"

#include <array>
#include <cstdint>

namespace volumic
{
/**
 * Which object each voxel belongs to. Objects are numbered from 1, 0 is none of them: labels that
 * nobody asks for, and what is outside the map.
 */
struct LabelMap
{
  using Number = std::uint16_t;

  std::array<int, 3> Size = { 0, 0, 0 };
  /** Distances of voxels along the axes, in the smallest of them, as all lengths of the fields. */
  std::array<double, 3> Spacing = { 1., 1., 1. };
  LargeVector<Number> Voxels; ///< x fastest
  int NumberOfObjects = 0;    ///< the largest number that a voxel may have

  Number At(int i, int j, int k) const
  {
    const bool isInside = i >= 0 && j >= 0 && k >= 0 && i < this->Size[0] && j < this->Size[1] &&
      k < this->Size[2];
    return isInside
      ? this->Voxels[static_cast<std::size_t>(VoxelBox::Of(this->Size).NumberOf(i, j, k))]
      : Number(0);
  }
};
}

#endif
