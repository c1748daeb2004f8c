// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelMapPadding.h"

#include "Core/Common/ThrowInvalidArgument.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace volumic
{
namespace
{
/**
 * The map is not periodic if the fraction of differing voxels exceeds FewVoxels plus MostTimes the
 * maximum fraction between neighbouring slices.
 */
constexpr double FewVoxels = 0.01;
constexpr double MostTimes = 2.;

/** Return the fraction of voxels that differ between two slices normal to an axis. */
double DifferenceOf(
  const LabelMap& map, const VoxelBox& box, int axis, const std::array<int, 2>& slices)
{
  VoxelBox first = box;
  first.First[axis] = slices[0];
  first.End[axis] = slices[0] + 1;
  std::int64_t count = 0;
  first.ForVoxels(
    [&](int i, int j, int k)
    {
      std::array<int, 3> other = { i, j, k };
      other[axis] = slices[1];
      count += map.At(i, j, k) != map.At(other[0], other[1], other[2]) ? 1 : 0;
    });
  return static_cast<double>(count) / static_cast<double>(first.Count());
}
}

void PadLabelMap(LabelMap& map, const VoxelBox& box, bool isPeriodic)
{
  const auto sourceOf = [&](int at, int axis) {
    return isPeriodic ? box.Wrapped(at, axis) : std::clamp(at, box.First[axis], box.End[axis] - 1);
  };
  for (const VoxelBox& part : VoxelBox::Of(map.Size()).Without(box))
  {
    part.ForVoxels([&](int i, int j, int k)
      { map.Set(i, j, k, map.At(sourceOf(i, 0), sourceOf(j, 1), sourceOf(k, 2))); });
  }
}

void CheckPeriodic(const LabelMap& map, const VoxelBox& box)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int last = box.End[axis] - 1;
    const double across = DifferenceOf(map, box, axis, { last, box.First[axis] });
    double most = 0.;
    for (int slice = box.First[axis]; slice < last; ++slice)
    {
      most = std::max(most, DifferenceOf(map, box, axis, { slice, slice + 1 }));
    }
    if (across > MostTimes * most + FewVoxels)
    {
      ThrowInvalidArgument("Box Faces is periodic, but the labels are not periodic along ",
        "xyz"[axis], ": the first and the last slice differ in ", std::lround(100. * across),
        " % of the voxels, neighbouring slices in at most ", std::lround(100. * most),
        " %. Set Box Faces to flat, or provide a volume of one period in which each grain has the "
        "same label on both sides.");
    }
  }
}
}
