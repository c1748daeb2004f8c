// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelSides.h"

#include "Core/Common/Lanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Maximum distance of surface vertices from the voxel boundary, in voxels. */
constexpr int LeastReach = 2;
/** A Gaussian moves the boundary at the corner of a cube by 0.82 sigma along each axis. */
constexpr double ReachInSigmas = 0.85;

template <typename Visitor>
void ForNeighbors(const VoxelBits& bits, Visitor&& visit)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const bool isNext : { false, true })
    {
      visit(axis, isNext, bits.Neighbored(axis, isNext));
    }
  }
}
}

LabelSides::LabelSides(const LabelBricks& bricks, int object, const VoxelBox& within)
{
  constexpr int side = LabelBricks::Side;
  VoxelBox box = bricks.ExtentOf(object).Bricks.CommonWith(within).Grown(1);
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] *= side;
    box.End[axis] *= side;
  }
  this->Members = VoxelBits(box);
  const VoxelBox inMap = box.CommonWith(VoxelBox::Of(bricks.Map().Size()));
  for (const VoxelBox& part : object == 0 ? box.Without(inMap) : std::vector<VoxelBox>())
  {
    this->Members.Add(part); // Voxels outside the map are background.
  }
  bricks.Map().ForParts(inMap,
    [&](const VoxelBox& part, LabelMap::Number other)
    {
      if (other == object)
      {
        this->Members.Add(part);
      }
    });
}

void LabelSides::CopyMembership(int i, int j, int k, int count, float* values) const
{
  static const auto fours = []
  {
    std::array<std::array<float, Lanes::Count>, 16> all;
    for (unsigned bits = 0; bits < all.size(); ++bits)
    {
      for (unsigned n = 0; n < Lanes::Count; ++n)
      {
        all[bits][n] = static_cast<float>(bits >> n & 1u);
      }
    }
    return all;
  }();
  for (int x = 0; x < count; x += Lanes::Count)
  {
    Lanes::Load(fours[this->Members.FourAt(i + x, j, k)].data()).Store(values + x);
  }
}

VoxelBits LabelSides::NearBoundary(const std::array<int, 3>& reach) const
{
  const VoxelBits others = VoxelBits(this->Box(), true) - this->Members;
  return (this->Members.Grown(reach) & others.Grown(reach)).InFours();
}

std::array<int, 3> LabelSides::ReachOfFields(double sigma, const std::array<double, 3>& spacing)
{
  std::array<int, 3> reach;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int moved = static_cast<int>(std::ceil(ReachInSigmas * sigma / spacing[axis]));
    reach[axis] = std::max(LeastReach, moved);
  }
  return reach;
}

VoxelBits LabelSides::FindThin() const
{
  VoxelBits thin(this->Box());
  for (int axis = 0; axis < 3; ++axis)
  {
    thin |= (this->Members ^ this->Members.Neighbored(axis, false)) &
      (this->Members ^ this->Members.Neighbored(axis, true));
  }
  return thin;
}

VoxelBits LabelSides::FindBeside(const VoxelBits& others) const
{
  VoxelBits beside(this->Box());
  ForNeighbors(this->Members,
    [&](int axis, bool isNext, VoxelBits neighbors)
    { beside |= (neighbors ^= this->Members) &= others.Neighbored(axis, isNext); });
  return beside;
}

VoxelBits LabelSides::FindMissed(
  const LabelField& field, const VoxelBits& rows, Executor& executor) const
{
  VoxelBits misclassified(this->Box());
  rows.For(executor,
    [&](int i, int j, int k, int count)
    {
      const float* values = field.Values.data() + field.Box.NumberOf(i, j, k);
      for (int x = 0; x < count; x += Lanes::Count)
      {
        const Lanes four = Lanes::Load(values + x);
        const unsigned members = this->Members.FourAt(i + x, j, k);
        const unsigned correct =
          (LessBits(Lanes(0.f), four) & members) | (LessBits(four, Lanes(0.f)) & ~members);
        misclassified.AddFour(i + x, j, k, ~correct & 15u);
      }
    });
  if (!misclassified.IsEmpty())
  {
    const VoxelBits correct = VoxelBits(this->Box(), true) - misclassified;
    ForNeighbors(this->Members,
      [&](int axis, bool isNext, VoxelBits neighbors)
      { misclassified -= correct.Neighbored(axis, isNext) - (neighbors ^= this->Members); });
  }
  return misclassified;
}
}
