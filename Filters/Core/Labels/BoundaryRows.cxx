// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/BoundaryRows.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Each place gets the bits of those at most `reach` away along an axis. */
std::vector<unsigned char> Spread(const std::vector<unsigned char>& bits,
  const std::array<int, 3>& size, int axis, int reach)
{
  std::vector<unsigned char> spread(bits.size(), 0);
  const VoxelBox all = VoxelBox::Of(size);
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i)
      {
        std::array<int, 3> at = { i, j, k };
        const int first = std::max(0, at[axis] - reach);
        const int last = std::min(size[axis] - 1, at[axis] + reach);
        unsigned char& place = spread[static_cast<std::size_t>(all.NumberOf(i, j, k))];
        for (at[axis] = first; at[axis] <= last; ++at[axis])
        {
          place |= bits[static_cast<std::size_t>(all.NumberOf(at[0], at[1], at[2]))];
        }
      }
    }
  }
  return spread;
}
}

BoundaryRows::BoundaryRows(const LabelBricks& bricks, int object, const VoxelBox& within)
{
  constexpr int side = LabelBricks::Side;
  constexpr unsigned char isObject = 1;
  constexpr unsigned char isOther = 2;
  const VoxelBox inner = bricks.ExtentOf(object).Bricks.CommonWith(within);
  std::array<int, 3> first = inner.First;
  for (int axis = 0; axis < 3; ++axis)
  {
    --first[axis];
    this->Count[axis] = inner.Length(axis) + 2;
    this->Voxels.First[axis] = first[axis] * side;
    this->Voxels.End[axis] = (inner.End[axis] + 1) * side;
  }
  const VoxelBox all = VoxelBox::Of(this->Count);
  const VoxelBox map = VoxelBox::Of(bricks.Size());
  // Outside the map all is 0.
  std::vector<unsigned char> sides(
    static_cast<std::size_t>(all.Count()), object == 0 ? isObject : isOther);
  for (int k = 0; k < this->Count[2]; ++k)
  {
    for (int j = 0; j < this->Count[1]; ++j)
    {
      for (int i = 0; i < this->Count[0]; ++i)
      {
        const std::array<int, 3> at = { first[0] + i, first[1] + j, first[2] + k };
        if (!map.Contains(at))
        {
          continue;
        }
        sides[static_cast<std::size_t>(all.NumberOf(i, j, k))] = isOther;
        const LabelBricks::Range found = bricks.ObjectsIn(at[0], at[1], at[2]);
        if (found.Has(static_cast<LabelMap::Number>(object)))
        {
          const bool isMixed = found.end() - found.begin() > 1;
          sides[static_cast<std::size_t>(all.NumberOf(i, j, k))] =
            static_cast<unsigned char>(isObject | (isMixed ? isOther : 0));
        }
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    sides = Spread(sides, this->Count, axis, 1);
  }
  this->Mask.resize(sides.size());
  std::transform(sides.begin(), sides.end(), this->Mask.begin(),
    [](unsigned char both)
    { return static_cast<unsigned char>(both == (isObject | isOther) ? 1 : 0); });
}

BoundaryRows BoundaryRows::Grown(int axis, int voxels) const
{
  constexpr int side = LabelBricks::Side;
  BoundaryRows grown = *this;
  grown.Mask = Spread(this->Mask, this->Count, axis, (voxels + side - 1) / side);
  return grown;
}
}
