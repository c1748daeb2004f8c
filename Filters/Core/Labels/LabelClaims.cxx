// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelClaims.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
constexpr int Side = LabelBricks::Side;
constexpr int VoxelsOfBrick = Side * Side * Side;
}

LabelClaims::LabelClaims(const LabelBricks& bricks)
  : Bricks(&bricks)
{
  const VoxelBox all = VoxelBox::Of(bricks.Size());
  this->Places.assign(static_cast<std::size_t>(all.Count()), -1);
  int count = 0;
  for (int k = 0; k < bricks.Size()[2] && bricks.HasContested(); ++k)
  {
    for (int j = 0; j < bricks.Size()[1]; ++j)
    {
      for (int i = 0; i < bricks.Size()[0]; ++i)
      {
        if (bricks.IsContested(i, j, k))
        {
          this->Places[static_cast<std::size_t>(all.NumberOf(i, j, k))] = count++;
        }
      }
    }
  }
  this->All.resize(static_cast<std::size_t>(count) * VoxelsOfBrick);
}

template <typename Visitor>
void LabelClaims::ForVoxels(const LabelField& field, Visitor&& visit) const
{
  const VoxelBox map = VoxelBox::Of(this->Bricks->Size());
  VoxelBox bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    // The box is one of whole bricks.
    bricks.First[axis] = std::max(0, field.Box.First[axis] / Side);
    bricks.End[axis] = std::min(map.End[axis], field.Box.End[axis] / Side);
  }
  for (int k = bricks.First[2]; k < bricks.End[2]; ++k)
  {
    for (int j = bricks.First[1]; j < bricks.End[1]; ++j)
    {
      for (int i = bricks.First[0]; i < bricks.End[0]; ++i)
      {
        const int place = this->Places[static_cast<std::size_t>(map.NumberOf(i, j, k))];
        for (int v = 0; place >= 0 && v < VoxelsOfBrick; ++v)
        {
          visit(static_cast<std::size_t>(place) * VoxelsOfBrick + static_cast<std::size_t>(v),
            field.Box.NumberOf(i * Side + v % Side, j * Side + v / Side % Side,
              k * Side + v / (Side * Side)));
        }
      }
    }
  }
}

void LabelClaims::Add(int object, const LabelField& field)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->ForVoxels(field,
    [&](std::size_t at, std::int64_t voxel)
    {
      Claims& claims = this->All[at];
      const float claim = field.Values[static_cast<std::size_t>(voxel)];
      if (claim > claims.Most)
      {
        claims.Second = claims.Most;
        claims.Most = claim;
        claims.Claimant = static_cast<LabelMap::Number>(object);
      }
      else
      {
        claims.Second = std::max(claims.Second, claim);
      }
    });
}

void LabelClaims::Settle(int object, LabelField& field) const
{
  this->ForVoxels(field,
    [&](std::size_t at, std::int64_t voxel)
    {
      const Claims& claims = this->All[at];
      const float other = claims.Claimant == object ? claims.Second : claims.Most;
      float& value = field.Values[static_cast<std::size_t>(voxel)];
      value = std::min(value, 0.5f * (value - other));
    });
}
}
