// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceLattice.h"

#include "Core/Interfaces/LatticeCutter.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace volumic
{
namespace
{
/** The pitch of a lattice, at most, in wanted edges: triangles are half as large. */
constexpr double MostPitch = 1.7;
/** So many voxels of an object, or one in so many, may be without a point of the lattice near. */
constexpr std::int64_t MostWithout = 8;
constexpr std::int64_t MostWithoutShare = 1000;
using Pitches = std::array<int, 3>;

/** Whether it is a corner or a middle of a cube, along axes where these are at every second voxel.
 */
bool IsSite(const Pitches& pitch, const std::array<int, 3>& voxel)
{
  bool hasEven = false;
  bool hasOdd = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool isOdd = (voxel[axis] & 1) != 0;
    hasEven = hasEven || (pitch[axis] == 2 && !isOdd);
    hasOdd = hasOdd || (pitch[axis] == 2 && isOdd);
  }
  return !(hasEven && hasOdd);
}

/** Whether a point of the lattice beside a voxel, or at it, has its object. */
bool IsHeld(const LabelMap& map, const Pitches& pitch, int i, int j, int k)
{
  const LabelMap::Number object = map.At(i, j, k);
  for (int z = k - 1; z <= k + 1; ++z)
  {
    for (int y = j - 1; y <= j + 1; ++y)
    {
      for (int x = i - 1; x <= i + 1; ++x)
      {
        if (IsSite(pitch, { x, y, z }) && map.At(x, y, z) == object)
        {
          return true;
        }
      }
    }
  }
  return false;
}

/** Whether the lattice has all objects whole. */
bool HoldsObjects(const LabelBricks& bricks, const Pitches& pitch, Executor& executor)
{
  constexpr int side = LabelBricks::Side;
  const LabelMap& map = bricks.Map();
  const auto objects = static_cast<std::size_t>(map.NumberOfObjects) + 1;
  std::vector<std::int64_t> without(objects, 0);
  std::mutex mutex;
  executor.For(static_cast<std::size_t>(map.Size()[2]), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<std::int64_t> own(objects, 0);
      for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      {
        for (int j = 0; j < map.Size()[1]; ++j)
        {
          for (int brick = 0; brick < bricks.Size()[0]; ++brick)
          {
            const LabelBricks::Range range = bricks.ObjectsIn(brick, j / side, k / side);
            const bool hasSeveral = range.end() - range.begin() > 1;
            const int end = hasSeveral ? std::min((brick + 1) * side, map.Size()[0]) : 0;
            for (int i = brick * side; i < end; ++i)
            {
              own[map.At(i, j, k)] += IsHeld(map, pitch, i, j, k) ? 0 : 1;
            }
          }
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      std::transform(own.begin(), own.end(), without.begin(), without.begin(), std::plus<>());
    });
  for (std::size_t object = 1; object < objects; ++object)
  {
    const std::int64_t voxels = bricks.ExtentOf(static_cast<int>(object)).Voxels;
    if (without[object] > std::max(MostWithout, voxels / MostWithoutShare) ||
      2 * without[object] > voxels)
    {
      return false;
    }
  }
  return true;
}
}

InterfaceLattice::InterfaceLattice(const InterfaceFields& fields, double edge, Executor& executor)
  : Fields(fields)
{
  Pitches pitch;
  std::transform(fields.Step().begin(), fields.Step().end(), pitch.begin(),
    [edge](double step) { return 2. * step <= MostPitch * edge ? 2 : 1; });
  if (pitch != this->Distances && !fields.HaveBox() &&
    HoldsObjects(fields.Bricks(), pitch, executor))
  {
    this->Distances = pitch;
  }
}

InterfaceMesh InterfaceLattice::Start(Executor& executor) const
{
  LatticeCutter cutter(this->Fields, this->Distances);
  cutter.FollowFields(executor);
  cutter.KeepGaps();
  cutter.FindMiddles(executor);
  const std::array<int, 3>& bricks = this->Fields.Bricks().Size();
  for (int k = 0; k < bricks[2]; ++k)
  {
    for (int j = 0; j < bricks[1]; ++j)
    {
      for (int i = 0; i < bricks[0]; ++i)
      {
        if (this->Fields.HasInterfaces(i, j, k) || cutter.HasSides(i, j, k))
        {
          cutter.CutBrick(i, j, k);
        }
      }
    }
  }
  return cutter.Take();
}
}
