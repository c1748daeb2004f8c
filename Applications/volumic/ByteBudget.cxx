// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ByteBudget.h"

#include "ToolErrors.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <limits>
#include <string>

namespace tool
{
std::uint64_t Times(std::uint64_t a, std::uint64_t b)
{
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return a != 0 && b > most / a ? most : a * b;
}

std::uint64_t BytesOfVoxels(int type, int components, const std::array<int, 3>& size)
{
  std::uint64_t bytes = Times(static_cast<std::uint64_t>(vtkDataArray::GetDataTypeSize(type)),
    static_cast<std::uint64_t>(components));
  for (const int count : size)
  {
    bytes = Times(bytes, static_cast<std::uint64_t>(count));
  }
  return bytes;
}

std::uint64_t MostUnpacked(std::uint64_t voxels, std::uint64_t before)
{
  if (before > LargestHeader)
  {
    throw Failure("its header is damaged: the voxels begin at byte " + std::to_string(before) +
      " of what is packed, where no header is that long");
  }
  return voxels + std::min(before, std::numeric_limits<std::uint64_t>::max() - voxels);
}

void NeedPackedBytes(std::uint64_t there, std::uint64_t most, std::uint64_t needed)
{
  if (Times(there, most) < needed)
  {
    NeedBytes(there, needed);
  }
}

void NeedBytes(std::uint64_t there, std::uint64_t needed)
{
  if (there < needed)
  {
    throw Failure("the file is cut off: it has " + std::to_string(there) +
      " bytes of voxels, its header asks for " + std::to_string(needed) + "; copy it again");
  }
}

void NeedJustBytes(std::uint64_t there, std::uint64_t needed)
{
  NeedBytes(there, needed);
  if (there > needed)
  {
    throw Failure("the file is too long: it has " + std::to_string(there) +
      " bytes of voxels, its header asks for " + std::to_string(needed) +
      "; copy it again, or, if what is too much is its end, cut that off (truncate -s -" +
      std::to_string(there - needed) + ")");
  }
}
}
