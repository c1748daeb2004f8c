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
/** Minimum size of a connected part of an object. */
struct PartSize
{
  int Voxels;
  int Thickness; ///< edge length of the cubes of voxels that form it: 1 or 2
};
/**
 * Smallest part that a surface can represent at a level. By experiment: a surface that shrinks from
 * outside vanishes in about half of the balls of 12 to 31 such voxels, and in none of 36 or more.
 * Rods and plates of such cubes always keep a surface.
 */
constexpr PartSize SmallestPart = { 36, 2 };

/**
 * Search for a part of an object that consists of cubes of voxels, connected by faces. Each part is
 * followed up to the requested number of voxels only.
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

  /** Return whether a part is large enough. */
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

  /** Return whether a voxel lies in a cube. */
  bool IsThick(const std::array<int, 3>& voxel) const
  {
    for (int c = 0; c < this->NumberOfCorners; ++c)
    {
      const int i = voxel[0] - (c & 1);
      const int j = voxel[1] - (c >> 1 & 1);
      const int k = voxel[2] - (c >> 2);
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
   * Return whether the part of a voxel is large enough, if the voxel is the first of its part.
   * Otherwise the part has been tested before.
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
      const std::array<int, 3> voxel = this->Numbers.IjkOf(this->Part[n]);
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int side : { -1, 1 })
        {
          std::array<int, 3> next = voxel;
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
  int Least; ///< number of voxels
  int More;  ///< edge length of a cube minus 1
  int NumberOfCorners;
  std::array<std::int64_t, 8> Corners;
  std::vector<std::int64_t> Part;
};

/**
 * Return whether the voxels with isObject(number) (VoxelNumbers.h) have a part of at least this
 * size. Thinner parts do not count.
 */
template <typename IsObject>
bool HasThickPart(const IsObject& isObject, const std::array<int, 3>& size, const PartSize& least)
{
  return ThickParts<IsObject>(isObject, size, least).HaveOne();
}
}

#endif
