// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ThickPart.h"

#include "Core/Image/VoxelNumbers.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** The voxels of all cubes of 2 x 2 x 2 that are marked throughout. */
std::vector<std::uint8_t> InCubes(
  const std::vector<std::uint8_t>& marks, const std::array<int, 3>& size)
{
  const VoxelNumbers numbers(size);
  std::array<std::int64_t, 8> corners;
  for (int c = 0; c < 8; ++c)
  {
    corners[c] = numbers.Of(c & 1, c >> 1 & 1, c >> 2);
  }
  std::vector<std::uint8_t> found(marks.size(), 0);
  for (int k = 0; k + 1 < size[2]; ++k)
  {
    for (int j = 0; j + 1 < size[1]; ++j)
    {
      for (int i = 0; i + 1 < size[0]; ++i)
      {
        const std::int64_t first = numbers.Of(i, j, k);
        if (std::all_of(corners.begin(), corners.end(),
              [&](std::int64_t corner) { return marks[first + corner] != 0; }))
        {
          for (const std::int64_t corner : corners)
          {
            found[first + corner] = 1;
          }
        }
      }
    }
  }
  return found;
}
}

bool HasThickPart(
  const std::vector<std::uint8_t>& marks, const std::array<int, 3>& size, int minimum)
{
  const VoxelNumbers numbers(size);
  std::vector<std::uint8_t> left = InCubes(marks, size);
  std::vector<std::int64_t> part;
  for (auto seed = left.begin();; ++seed)
  {
    seed = std::find(seed, left.end(), std::uint8_t(1));
    if (seed == left.end())
    {
      return false;
    }
    *seed = 0;
    part.assign(1, seed - left.begin());
    for (std::size_t n = 0; n < part.size(); ++n)
    {
      const std::array<int, 3> place = numbers.PlaceOf(part[n]);
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int side : { -1, 1 })
        {
          const int next = place[axis] + side;
          const std::int64_t other = part[n] + side * numbers.Stride(axis);
          if (next >= 0 && next < size[axis] && left[other] != 0)
          {
            left[other] = 0;
            part.push_back(other);
          }
        }
      }
    }
    if (part.size() >= static_cast<std::size_t>(minimum))
    {
      return true;
    }
  }
}
}
