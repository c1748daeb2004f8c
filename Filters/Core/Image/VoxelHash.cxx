// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/VoxelHash.h"

#include "Core/Common/ContentHash.h"

#include <cstring>
#include <numeric>
#include <vector>

namespace volumic
{
namespace
{
/** Rows that one thread takes at a time. */
constexpr std::size_t RowsOfSpan = 64;

/** @param first the number of the first voxel in the image */
template <typename Word>
std::uint64_t HashOfRow(const char* voxels, std::int64_t count, std::int64_t first)
{
  std::uint64_t sum = 0;
  for (std::int64_t i = 0; i < count; ++i)
  {
    Word word;
    std::memcpy(&word, voxels + i * static_cast<std::int64_t>(sizeof(Word)), sizeof(Word));
    sum += CombineHashes(static_cast<std::uint64_t>(first + i), word);
  }
  return sum;
}

std::uint64_t HashOfRow(
  const char* voxels, std::size_t bytes, std::int64_t count, std::int64_t first)
{
  switch (bytes)
  {
    case 1:
      return HashOfRow<std::uint8_t>(voxels, count, first);
    case 2:
      return HashOfRow<std::uint16_t>(voxels, count, first);
    case 4:
      return HashOfRow<std::uint32_t>(voxels, count, first);
    default:
      return HashOfRow<std::uint64_t>(voxels, count, first);
  }
}
}

std::uint64_t HashOfVoxels(const void* voxels, std::size_t bytes, const VoxelBox& held,
  const VoxelBox& part, const VoxelBox& image, Executor& executor)
{
  const auto rows = part.IsEmpty() ? 0
                                   : static_cast<std::size_t>(part.Length(1)) *
      static_cast<std::size_t>(part.Length(2));
  std::vector<std::uint64_t> sums((rows + RowsOfSpan - 1) / RowsOfSpan);
  ForSpans(executor, rows, RowsOfSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        const int i = part.First[0];
        const int j = part.First[1] + static_cast<int>(row) % part.Length(1);
        const int k = part.First[2] + static_cast<int>(row) / part.Length(1);
        const char* first = static_cast<const char*>(voxels) +
          held.NumberOf(i, j, k) * static_cast<std::int64_t>(bytes);
        sums[span] += HashOfRow(first, bytes, part.Length(0), image.NumberOf(i, j, k));
      }
    });
  return std::accumulate(sums.begin(), sums.end(), std::uint64_t(0));
}
}
