// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/PyramidGeometry.h"

#include "Core/Common/ThrowInvalidArgument.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
void CheckReductionFactor(double factor)
{
  // The negation rejects NaN, too.
  if (!(factor > 1.0 && factor < 2.0))
  {
    ThrowInvalidArgument("Reduction Factor is ", factor,
      "; it must lie between 1 and 2, both excluded", " (sqrt(3) suits the deformable surface).");
  }
}

void CheckImage(const LevelSize& size, const std::array<double, 3>& spacing)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (size[axis] < 1)
    {
      ThrowInvalidArgument(
        "the image is empty: it has ", size[0], " x ", size[1], " x ", size[2], " voxels.");
    }
    if (size[axis] > 1 && (!std::isfinite(spacing[axis]) || spacing[axis] == 0.0))
    {
      ThrowInvalidArgument("the spacing along axis ", "xyz"[axis], " is ", spacing[axis],
        "; set it to the distance of two voxels.");
    }
  }
}

double UnitOfLevel0(const LevelSize& size, const std::array<double, 3>& spacing)
{
  double unit = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double distance = std::abs(spacing[axis]);
    if (size[axis] > 1 && (unit == 0.0 || distance < unit))
    {
      unit = distance;
    }
  }
  return unit > 0.0 ? unit : 1.0; // An image of one voxel has no distances.
}

bool IsSmallerThan(const LevelSize& level, const LevelSize& level0, std::int64_t minimum)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (level0[axis] > 1 && level[axis] < minimum)
    {
      return true;
    }
  }
  return false;
}
}

LevelSize ReducedSize(const LevelSize& size, double reductionFactor)
{
  LevelSize reduced;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double quotient = std::floor(static_cast<double>(size[axis]) / reductionFactor);
    reduced[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(quotient));
  }
  return reduced;
}

int MaximumNumberOfLevels(const LevelSize& size, double reductionFactor)
{
  CheckReductionFactor(reductionFactor);
  int levels = 1;
  // Each axis of two voxels or more shrinks, because T > 1.
  for (LevelSize level = size; level[0] > 1 || level[1] > 1 || level[2] > 1; ++levels)
  {
    level = ReducedSize(level, reductionFactor);
  }
  return levels;
}

std::vector<LevelGeometry> PlanPyramid(
  const LevelSize& size, const std::array<double, 3>& spacing, const PyramidOptions& options)
{
  const int possible = MaximumNumberOfLevels(size, options.ReductionFactor);
  CheckImage(size, spacing);
  if (options.NumberOfLevels < 0)
  {
    ThrowInvalidArgument("Number Of Levels is ", options.NumberOfLevels,
      "; use 0 for as many as Minimum Level Size allows, or 1 and more.");
  }
  if (options.NumberOfLevels > possible)
  {
    ThrowInvalidArgument("Number Of Levels is ", options.NumberOfLevels, ", but an image of ",
      size[0], " x ", size[1], " x ", size[2], " voxels gives at most ", possible,
      " levels with Reduction Factor ", options.ReductionFactor,
      "; ask for fewer, or use 0 for the automatic choice.");
  }
  if (options.MinimumLevelSize < 1)
  {
    ThrowInvalidArgument(
      "Minimum Level Size is ", options.MinimumLevelSize, "; it must be at least 1.");
  }

  const bool automatic = options.NumberOfLevels == 0;
  const int requested = automatic ? possible : options.NumberOfLevels;

  std::vector<LevelGeometry> levels(1);
  levels[0].Size = size;
  levels[0].Spacing = spacing;
  levels[0].Unit = UnitOfLevel0(size, spacing);
  while (static_cast<int>(levels.size()) < requested)
  {
    LevelGeometry next;
    next.Size = ReducedSize(levels.back().Size, options.ReductionFactor);
    if (automatic && IsSmallerThan(next.Size, size, options.MinimumLevelSize))
    {
      break;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      next.Spacing[axis] =
        spacing[axis] * (static_cast<double>(size[axis]) / static_cast<double>(next.Size[axis]));
    }
    next.Unit = levels.back().Unit * options.ReductionFactor;
    levels.push_back(next);
  }
  return levels;
}
}
