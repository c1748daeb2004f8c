// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/VoxelBits.h"

#include "Core/Common/Lanes.h"

#include <algorithm>

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

VoxelBits& VoxelBits::operator&=(const VoxelBits& other)
{
  std::transform(this->Bits.begin(), this->Bits.end(), other.Bits.begin(), this->Bits.begin(),
    [](Word a, Word b) { return a & b; });
  return *this;
}

VoxelBits& VoxelBits::operator|=(const VoxelBits& other)
{
  std::transform(this->Bits.begin(), this->Bits.end(), other.Bits.begin(), this->Bits.begin(),
    [](Word a, Word b) { return a | b; });
  return *this;
}

VoxelBits& VoxelBits::operator^=(const VoxelBits& other)
{
  std::transform(this->Bits.begin(), this->Bits.end(), other.Bits.begin(), this->Bits.begin(),
    [](Word a, Word b) { return a ^ b; });
  return *this;
}

VoxelBits& VoxelBits::operator-=(const VoxelBits& other)
{
  std::transform(this->Bits.begin(), this->Bits.end(), other.Bits.begin(), this->Bits.begin(),
    [](Word a, Word b) { return a & ~b; });
  return *this;
}

int VoxelBits::FindBit(const Word* row, int x, int count, Word inversion)
{
  while (x < count)
  {
    const Word rest = (row[x / WordSize] ^ inversion) >> x % WordSize;
    if (rest != 0)
    {
      return std::min(count, x + LowestBit(rest));
    }
    x = (x / WordSize + 1) * WordSize;
  }
  return count;
}

template <typename Combine>
void VoxelBits::CombineRows(int axis, int by, const VoxelBits& others, Combine&& combine)
{
  // Rows follow each other along y, then along z: what is combined is all of a layer, or of a box.
  const std::size_t step =
    static_cast<std::size_t>(this->Words) * (axis == 1 ? 1 : this->Voxels.Length(1));
  const std::size_t block = step * static_cast<std::size_t>(this->Voxels.Length(axis));
  const std::size_t length = step * static_cast<std::size_t>(std::abs(by));
  for (std::size_t first = 0; first < this->Bits.size() && length < block; first += block)
  {
    Word* to = this->Bits.data() + first + (by < 0 ? length : 0);
    const Word* from = others.Bits.data() + first + (by < 0 ? 0 : length);
    for (std::size_t w = 0; w < block - length; ++w)
    {
      to[w] = combine(to[w], from[w]);
    }
  }
}

VoxelBits VoxelBits::Neighbored(int axis, bool isNext) const
{
  VoxelBits neighbored(this->Voxels);
  if (axis > 0)
  {
    neighbored.CombineRows(axis, isNext ? 1 : -1, *this, [](Word, Word other) { return other; });
    return neighbored;
  }
  const auto words = static_cast<std::size_t>(this->Words);
  const Word inLast = ~Word(0) >> (this->Words * WordSize - this->Voxels.Length(0));
  for (std::size_t first = 0; first < this->Bits.size(); first += words)
  {
    const Word* row = this->Bits.data() + first;
    Word* to = neighbored.Bits.data() + first;
    for (std::size_t w = 0; w < words; ++w)
    {
      const Word before = w > 0 ? row[w - 1] >> (WordSize - 1) : 0;
      const Word after = w + 1 < words ? row[w + 1] << (WordSize - 1) : 0;
      to[w] = isNext ? row[w] >> 1 | after : row[w] << 1 | before;
    }
    to[words - 1] &= inLast;
  }
  return neighbored;
}

VoxelBits VoxelBits::Grown(int axis, int voxels) const
{
  VoxelBits grown = *this;
  for (int n = 1; n <= voxels; ++n)
  {
    if (axis == 0)
    {
      const VoxelBits before = grown;
      grown |= before.Neighbored(0, false);
      grown |= before.Neighbored(0, true);
      continue;
    }
    const auto both = [](Word word, Word other) { return word | other; };
    grown.CombineRows(axis, n, *this, both);
    grown.CombineRows(axis, -n, *this, both);
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
