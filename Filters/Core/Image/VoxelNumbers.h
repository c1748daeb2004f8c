// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelNumbers_h
#define volumicVoxelNumbers_h

#include <array>
#include <cstdint>

namespace volumic
{
/**
 * Linear indices of the voxels of an image, x fastest. 64 bits: 1300^3 voxels exceed an int.
 */
class VoxelNumbers
{
public:
  constexpr explicit VoxelNumbers(const std::array<int, 3>& size)
    : Size(size), Strides{ 1, size[0], static_cast<std::int64_t>(size[0]) * size[1] }
  {
  }

  constexpr std::int64_t Count() const { return this->Strides[2] * this->Size[2]; }

  /** Return the increment from a voxel to the next along an axis. */
  constexpr std::int64_t Stride(int axis) const { return this->Strides[axis]; }

  constexpr std::int64_t Of(int i, int j, int k) const
  {
    return i + j * this->Strides[1] + k * this->Strides[2];
  }

  constexpr std::array<int, 3> IjkOf(std::int64_t number) const
  {
    const std::int64_t inSlice = number % this->Strides[2];
    return { static_cast<int>(inSlice % this->Strides[1]),
      static_cast<int>(inSlice / this->Strides[1]), static_cast<int>(number / this->Strides[2]) };
  }

private:
  std::array<int, 3> Size;
  std::array<std::int64_t, 3> Strides;
};
}

#endif
