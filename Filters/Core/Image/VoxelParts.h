// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelParts_h
#define volumicVoxelParts_h

#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The parts that marked voxels (x fastest) form, one after the other: sets joined by faces, in the
 * order of their first voxels. Each voxel gets another mark as it is found.
 */
class VoxelParts
{
public:
  /** Of the voxels marked `wanted`, which get the mark `found`; `marks` must outlive it. */
  VoxelParts(std::vector<std::uint8_t>& marks, const std::array<int, 3>& size, std::uint8_t wanted,
    std::uint8_t found)
    : Marks(marks), Size(size), Numbers(size), Wanted(wanted), Found(found)
  {
  }

  /** The next part, valid until the next call; empty after the last. */
  const std::vector<std::int64_t>& Next()
  {
    this->Part.clear();
    const auto from = this->Marks.begin() + static_cast<std::ptrdiff_t>(this->Searched);
    const auto seed = std::find(from, this->Marks.end(), this->Wanted);
    this->Searched = static_cast<std::size_t>(seed - this->Marks.begin());
    if (seed != this->Marks.end())
    {
      this->Take(static_cast<std::int64_t>(this->Searched));
    }
    for (std::size_t n = 0; n < this->Part.size(); ++n)
    {
      const std::int64_t voxel = this->Part[n];
      const std::array<int, 3> place = this->Numbers.PlaceOf(voxel);
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int side : { -1, 1 })
        {
          const int next = place[axis] + side;
          const std::int64_t other = voxel + side * this->Numbers.Stride(axis);
          if (next >= 0 && next < this->Size[axis] && this->Marks[other] == this->Wanted)
          {
            this->Take(other);
          }
        }
      }
    }
    return this->Part;
  }

private:
  void Take(std::int64_t voxel)
  {
    this->Marks[voxel] = this->Found;
    this->Part.push_back(voxel);
  }

  std::vector<std::uint8_t>& Marks;
  std::array<int, 3> Size;
  VoxelNumbers Numbers;
  std::uint8_t Wanted;
  std::uint8_t Found;
  std::vector<std::int64_t> Part;
  std::size_t Searched = 0; ///< No voxel before this one has the mark any more.
};
}

#endif
