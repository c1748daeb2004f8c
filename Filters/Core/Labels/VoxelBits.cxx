// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/VoxelBits.h"

#include <algorithm>
#include <cstdlib>

namespace volumic
{
VoxelBits::VoxelBits(const VoxelBox& box, bool all)
  : Voxels(box), Words((box.Length(0) + WordSize - 1) / WordSize)
{
  this->Bits.assign(
    static_cast<std::size_t>(this->Words) * box.Length(1) * static_cast<std::size_t>(box.Length(2)),
    0);
  if (all)
  {
    this->Add(box);
  }
}

bool VoxelBits::IsEmpty() const
{
  return std::all_of(this->Bits.begin(), this->Bits.end(), [](Word word) { return word == 0; });
}

void VoxelBits::Add(const VoxelBox& part)
{
  const int first = part.First[0] - this->Voxels.First[0];
  const int end = part.End[0] - this->Voxels.First[0];
  for (int k = part.First[2]; k < part.End[2]; ++k)
  {
    for (int j = part.First[1]; j < part.End[1]; ++j)
    {
      Word* row = this->RowAt(j, k);
      for (int x = first; x < end;)
      {
        const int next = std::min(end, (x / WordSize + 1) * WordSize);
        row[x / WordSize] |= ~Word(0) >> (WordSize - (next - x)) << x % WordSize;
        x = next;
      }
    }
  }
}

void VoxelBits::AddShifted(const VoxelBits& others, int axis, int by)
{
  const auto words = static_cast<std::size_t>(this->Words);
  const auto length = static_cast<std::size_t>(std::abs(by));
  if (axis > 0)
  {
    const std::size_t step =
      words * (axis == 1 ? 1 : static_cast<std::size_t>(this->Voxels.Length(1)));
    const std::size_t block = step * static_cast<std::size_t>(this->Voxels.Length(axis));
    for (std::size_t first = 0; first < this->Bits.size() && length * step < block; first += block)
    {
      Word* to = this->Bits.data() + first + (by < 0 ? length * step : 0);
      const Word* from = others.Bits.data() + first + (by < 0 ? 0 : length * step);
      for (std::size_t w = 0; w < block - length * step; ++w)
      {
        to[w] |= from[w];
      }
    }
    return;
  }
  const Word inLast = ~Word(0) >> (this->Words * WordSize - this->Voxels.Length(0));
  for (std::size_t first = 0; first < this->Bits.size(); first += words)
  {
    const Word* from = others.Bits.data() + first;
    Word* to = this->Bits.data() + first;
    for (std::size_t w = 0; w < words; ++w)
    {
      to[w] |= by > 0 ? from[w] >> length | (w + 1 < words ? from[w + 1] << (WordSize - length) : 0)
                      : from[w] << length | (w > 0 ? from[w - 1] >> (WordSize - length) : 0);
    }
    to[words - 1] &= inLast;
  }
}

VoxelBits VoxelBits::Neighbored(int axis, bool isNext) const
{
  VoxelBits neighbored(this->Voxels);
  neighbored.AddShifted(*this, axis, isNext ? 1 : -1);
  return neighbored;
}

VoxelBits VoxelBits::Grown(int axis, int voxels) const
{
  VoxelBits grown = *this;
  for (int done = 0; done < voxels;)
  {
    // A set dilated by n, shifted by up to 2 n + 1 in both directions, leaves no gaps.
    const int step = std::min({ 2 * done + 1, voxels - done, WordSize - 1 });
    const VoxelBits before = grown;
    grown.AddShifted(before, axis, step);
    grown.AddShifted(before, axis, -step);
    done += step;
  }
  return grown;
}

VoxelBits VoxelBits::InFours() const
{
  VoxelBits fours = *this;
  for (Word& word : fours.Bits)
  {
    const Word pairs = word | word >> 1;
    word = ((pairs | pairs >> 2) & 0x11111111u) * 15u;
  }
  return fours;
}
}
