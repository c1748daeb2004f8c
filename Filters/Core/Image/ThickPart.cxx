// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ThickPart.h"

#include "Core/Image/VoxelNumbers.h"
#include "Core/Image/VoxelParts.h"

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
  std::vector<std::uint8_t> thick = InCubes(marks, size);
  VoxelParts parts(thick, size, 1, 0);
  for (const auto* part = &parts.Next(); !part->empty(); part = &parts.Next())
  {
    if (part->size() >= static_cast<std::size_t>(minimum))
    {
      return true;
    }
  }
  return false;
}
}
