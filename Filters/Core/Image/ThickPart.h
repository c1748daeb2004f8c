// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThickPart_h
#define volumicThickPart_h

#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** The least that a part of an object is to be. */
struct PartSize
{
  int Voxels;
  int Thickness; ///< Side of the cubes of voxels that it consists of: 1 or 2.
};
/**
 * What holds a surface at its level. Found by experiment: a surface that shrinks from outside
 * vanishes in about half of the balls of 12 to 31 such voxels, and in none of 36 and more; rods and
 * plates that consist of such cubes hold it always.
 */
constexpr PartSize PartThatHolds = { 36, 2 };

/**
 * Looks for parts of an object that consist of cubes of its voxels, joined by faces: each part in
 * turn, as far as needed, so that the work space is that of the few voxels wanted.
 */
template <typename IsObject>
class ThickParts
{
public:
  ThickParts(const IsObject& isObject, const std::array<int, 3>& size, const PartSize& least)
    : Object(isObject), Size(size), Numbers(size), Least(least.Voxels), More(least.Thickness - 1),
      NumberOfCorners(least.Thickness == 1 ? 1 : 8)
  {
    for (int c = 0; c < this->NumberOfCorners; ++c)
    {
      this->Corners[c] = this->Numbers.Of(c & 1, c >> 1 & 1, c >> 2);
    }
  }

  /** Whether there is one that is large enough. */
  bool HaveOne()
  {
    for (int k = 0; k + this->More < this->Size[2]; ++k)
    {
      for (int j = 0; j + this->More < this->Size[1]; ++j)
      {
        for (int i = 0; i + this->More < this->Size[0]; ++i)
        {
          const std::int64_t first = this->Numbers.Of(i, j, k);
          if (this->IsCube(first) && this->StartsPart(first))
          {
            return true;
          }
        }
      }
    }
    return false;
  }

private:
  bool IsCube(std::int64_t first) const
  {
    return std::all_of(this->Corners.begin(), this->Corners.begin() + this->NumberOfCorners,
      [&](std::int64_t corner) { return this->Object(first + corner); });
  }

  /** Whether the voxel lies in a cube. */
  bool IsThick(const std::array<int, 3>& place) const
  {
    for (int c = 0; c < this->NumberOfCorners; ++c)
    {
      const int i = place[0] - (c & 1);
      const int j = place[1] - (c >> 1 & 1);
      const int k = place[2] - (c >> 2);
      if (i >= 0 && j >= 0 && k >= 0 && i + this->More < this->Size[0] &&
        j + this->More < this->Size[1] && k + this->More < this->Size[2] &&
        this->IsCube(this->Numbers.Of(i, j, k)))
      {
        return true;
      }
    }
    return false;
  }

  /**
   * Whether the part of a voxel is large enough. Only asked of what may be the first voxel of its
   * part: where there is one before it, the part has been looked at, and has fewer.
   */
  bool StartsPart(std::int64_t first)
  {
    this->Part.assign(1, first);
    for (std::size_t n = 0; n < this->Part.size(); ++n)
    {
      if (this->Part.size() >= static_cast<std::size_t>(this->Least))
      {
        return true;
      }
      const std::array<int, 3> place = this->Numbers.IjkOf(this->Part[n]);
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int side : { -1, 1 })
        {
          std::array<int, 3> next = place;
          next[axis] += side;
          if (next[axis] < 0 || next[axis] >= this->Size[axis] || !this->IsThick(next))
          {
            continue;
          }
          const std::int64_t other = this->Part[n] + side * this->Numbers.Stride(axis);
          if (other < first)
          {
            return false;
          }
          if (std::find(this->Part.begin(), this->Part.end(), other) == this->Part.end())
          {
            this->Part.push_back(other);
          }
        }
      }
    }
    return false;
  }

  const IsObject& Object;
  std::array<int, 3> Size;
  VoxelNumbers Numbers;
  int Least; ///< Voxels.
  int More;  ///< Voxels of a cube along an axis beyond the first.
  int NumberOfCorners;
  std::array<std::int64_t, 8> Corners;
  std::vector<std::int64_t> Part;
};

/**
 * Whether the voxels for which isObject(number) holds (VoxelNumbers.h) have a part of at least that
 * size: of cubes of them, joined by faces. What is thinner doesn't count.
 */
template <typename IsObject>
bool HasThickPart(const IsObject& isObject, const std::array<int, 3>& size, const PartSize& least)
{
  return ThickParts<IsObject>(isObject, size, least).HaveOne();
}
}

#endif
