// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelBits_h
#define volumicVoxelBits_h

#include "Core/Common/Executor.h"
#include "Core/Common/Lanes.h"
#include "Core/Image/VoxelBox.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** A set of voxels of a box: one bit per voxel. Voxels outside the box are not in the set. */
class VoxelBits
{
  using Word = std::uint32_t;
  static constexpr int WordSize = 32;

public:
  VoxelBits() = default;
  /** Create a set of all voxels of a box, or of none. */
  explicit VoxelBits(const VoxelBox& box, bool all = false);

  const VoxelBox& Box() const { return this->Voxels; }

  bool Has(int i, int j, int k) const
  {
    const int x = i - this->Voxels.First[0];
    return this->Voxels.Contains({ i, j, k }) &&
      (this->RowAt(j, k)[x / WordSize] >> x % WordSize & 1u) != 0;
  }
  /** Return four voxels, bit n for voxel i + n; i - Box().First[0] is a multiple of 4. */
  unsigned FourAt(int i, int j, int k) const
  {
    const int x = i - this->Voxels.First[0];
    return this->RowAt(j, k)[x / WordSize] >> x % WordSize & 15u;
  }
  bool IsEmpty() const;

  /** Add the voxels of a box within the box of the set. */
  void Add(const VoxelBox& part);
  /** Add up to four voxels, bit n for voxel i + n; i as in FourAt(). */
  void AddFour(int i, int j, int k, unsigned bits)
  {
    const int x = i - this->Voxels.First[0];
    this->RowAt(j, k)[x / WordSize] |= bits << x % WordSize;
  }

  // Set operations; both sets must have the same box.
  VoxelBits& operator&=(const VoxelBits& other)
  {
    return this->Combine(other, [](Word a, Word b) { return a & b; });
  }
  VoxelBits& operator|=(const VoxelBits& other)
  {
    return this->Combine(other, [](Word a, Word b) { return a | b; });
  }
  VoxelBits& operator^=(const VoxelBits& other)
  {
    return this->Combine(other, [](Word a, Word b) { return a ^ b; });
  }
  VoxelBits& operator-=(const VoxelBits& other)
  {
    return this->Combine(other, [](Word a, Word b) { return a & ~b; });
  }
  friend VoxelBits operator&(VoxelBits a, const VoxelBits& b) { return a &= b; }
  friend VoxelBits operator^(VoxelBits a, const VoxelBits& b) { return a ^= b; }
  friend VoxelBits operator-(VoxelBits a, const VoxelBits& b) { return a -= b; }

  /** Return the voxels whose next (or else previous) neighbour along an axis is in the set. */
  VoxelBits Neighbored(int axis, bool isNext) const;
  /** Return the set dilated by a number of voxels along an axis. */
  VoxelBits Grown(int axis, int voxels) const;
  VoxelBits Grown(const std::array<int, 3>& voxels) const
  {
    return this->Grown(0, voxels[0]).Grown(1, voxels[1]).Grown(2, voxels[2]);
  }
  /** Return the set extended to whole groups of four voxels along x. */
  VoxelBits InFours() const;

  /**
   * Call visit(i, j, k, count) for each run of voxels along x, with its first voxel and length. The
   * runs of one slice are visited in order, on one thread.
   */
  template <typename Visitor>
  void For(Executor& executor, Visitor&& visit) const
  {
    ForSpans(executor, static_cast<std::size_t>(this->NumberOfLayers()), 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      { this->ForLayer(static_cast<int>(layer), visit); });
  }

  int NumberOfLayers() const { return this->Voxels.Length(2); }

  template <typename Visitor>
  void ForLayer(int layer, Visitor&& visit) const
  {
    const int k = this->Voxels.First[2] + layer;
    const int count = this->Voxels.Length(0);
    for (int j = this->Voxels.First[1]; j < this->Voxels.End[1]; ++j)
    {
      const Word* row = this->RowAt(j, k);
      for (int x = FindBit(row, 0, count, 0); x < count;)
      {
        const int end = FindBit(row, x, count, ~Word(0));
        visit(this->Voxels.First[0] + x, j, k, end - x);
        x = FindBit(row, end, count, 0);
      }
    }
  }

private:
  template <typename Operation>
  VoxelBits& Combine(const VoxelBits& other, Operation&& combine)
  {
    std::transform(
      this->Bits.begin(), this->Bits.end(), other.Bits.begin(), this->Bits.begin(), combine);
    return *this;
  }
  Word* RowAt(int j, int k)
  {
    return this->Bits.data() +
      static_cast<std::size_t>(this->Words) *
      (j - this->Voxels.First[1] +
        static_cast<std::size_t>(this->Voxels.Length(1)) * (k - this->Voxels.First[2]));
  }
  const Word* RowAt(int j, int k) const { return const_cast<VoxelBits*>(this)->RowAt(j, k); }
  /** Return the first bit at or after x that is set in row ^ inversion; `count` if none is. */
  static int FindBit(const Word* row, int x, int count, Word inversion)
  {
    while (x < count)
    {
      const Word remaining = (row[x / WordSize] ^ inversion) >> x % WordSize;
      if (remaining != 0)
      {
        return std::min(count, x + LowestBit(remaining));
      }
      x = (x / WordSize + 1) * WordSize;
    }
    return count;
  }
  /** Add the voxels whose neighbour at distance `by` along an axis is in another set. */
  void AddShifted(const VoxelBits& others, int axis, int by);

  VoxelBox Voxels;
  int Words = 0; ///< per row
  std::vector<Word> Bits;
};
}

#endif
