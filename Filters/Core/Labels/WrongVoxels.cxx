// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/WrongVoxels.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Where the surface crosses a row of voxels along x. */
struct Crossing
{
  std::int64_t Row;
  RowCrossing Where;

  bool operator<(const Crossing& other) const
  {
    return this->Row < other.Row || (this->Row == other.Row && this->Where.X < other.Where.X);
  }
};

/**
 * A whole number near the surface, along an axis: what is reckoned from there is the same wherever
 * the map begins.
 */
double NearSurface(const IndexedSurface& surface, int axis)
{
  return surface.Points.empty() ? 0. : std::floor(surface.Points.front()[axis]);
}

/** Of all rows of the map; X from NearSurface() on. */
std::vector<Crossing> FindCrossings(const std::array<int, 3>& size, const IndexedSurface& surface)
{
  const double base = NearSurface(surface, 0);
  const auto cornerOf = [&](const Triangle& t, int corner)
  {
    Point p = surface.Points[static_cast<std::size_t>(t[corner])];
    p[0] -= base;
    return p;
  };
  std::vector<Crossing> crossings;
  for (const Triangle& t : surface.Triangles)
  {
    const Point a = cornerOf(t, 0);
    const Point b = cornerOf(t, 1);
    const Point c = cornerOf(t, 2);
    int first[3];
    int last[3];
    for (int axis = 1; axis < 3; ++axis)
    {
      const double low = std::min({ a[axis], b[axis], c[axis] });
      const double high = std::max({ a[axis], b[axis], c[axis] });
      first[axis] = std::max(0, static_cast<int>(std::ceil(low)));
      last[axis] = std::min(size[axis] - 1, static_cast<int>(std::floor(high)));
    }
    for (int k = first[2]; k <= last[2]; ++k)
    {
      for (int j = first[1]; j <= last[1]; ++j)
      {
        const RowCrossing crossing = RowCrossing::Of(a, b, c, j, k);
        if (crossing.Winding != 0)
        {
          crossings.push_back({ static_cast<std::int64_t>(k) * size[1] + j, crossing });
        }
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}
}

std::vector<std::int64_t> FindWrongVoxels(
  const LabelBricks& bricks, int object, const IndexedSurface& surface, const VoxelBox& within)
{
  const LabelMap& map = bricks.Map();
  const std::vector<Crossing> crossings = FindCrossings(map.Size, surface);
  const double base = NearSurface(surface, 0);
  VoxelBox box = bricks.ExtentOf(object).Bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    // A surface stays within the field's box, which is larger by a brick.
    box.First[axis] = std::max(within.First[axis], (box.First[axis] - 1) * LabelBricks::Side);
    box.End[axis] = std::min(within.End[axis], (box.End[axis] + 1) * LabelBricks::Side);
  }
  std::vector<std::int64_t> wrong;
  const VoxelBox all = VoxelBox::Of(map.Size);
  for (int k = box.First[2]; k < box.End[2]; ++k)
  {
    for (int j = box.First[1]; j < box.End[1]; ++j)
    {
      const std::int64_t row = static_cast<std::int64_t>(k) * map.Size[1] + j;
      auto next = std::lower_bound(crossings.begin(), crossings.end(), row,
        [](const Crossing& crossing, std::int64_t number) { return crossing.Row < number; });
      const std::int64_t start = all.NumberOf(0, j, k);
      int winding = 0;
      for (int i = box.First[0]; i < box.End[0]; ++i)
      {
        for (; next != crossings.end() && next->Row == row && next->Where.X < i - base; ++next)
        {
          winding += next->Where.Winding;
        }
        const bool isObject = map.Voxels[static_cast<std::size_t>(start + i)] == object;
        if (isObject != (winding > 0))
        {
          wrong.push_back(start + i);
        }
      }
    }
  }
  return wrong;
}

std::vector<std::int64_t> FindMissedVoxels(const LabelMap& map,
  const std::vector<std::int64_t>& wrong, const IndexedSurface& surface, double tolerance)
{
  if (wrong.empty() || surface.Triangles.empty() || tolerance == 0.)
  {
    return wrong;
  }
  const auto scaled = [&](Point place)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = (place[axis] - NearSurface(surface, axis)) * map.Spacing[axis];
    }
    return place;
  };
  IndexedSurface inUnits = surface;
  for (Point& p : inUnits.Points)
  {
    p = scaled(p);
  }
  const TriangleTree tree(inUnits);
  const VoxelNumbers numbers(map.Size);
  std::vector<std::int64_t> missed;
  for (const std::int64_t voxel : wrong)
  {
    const auto [i, j, k] = numbers.PlaceOf(voxel);
    if (tree.SquaredDistance(scaled({ static_cast<double>(i), static_cast<double>(j),
          static_cast<double>(k) })) > tolerance * tolerance)
    {
      missed.push_back(voxel);
    }
  }
  return missed;
}

std::vector<std::int64_t> FindLostVoxels(
  const LabelMap& map, int object, const std::vector<std::int64_t>& wrong, bool isObject)
{
  const VoxelBox all = VoxelBox::Of(map.Size);
  const auto isWrong = [&](std::int64_t voxel)
  { return std::binary_search(wrong.begin(), wrong.end(), voxel); };
  const auto isOfSide = [&](int i, int j, int k) { return (map.At(i, j, k) == object) == isObject; };
  const auto isKept = [&](int i, int j, int k)
  {
    return isOfSide(i, j, k) && !(all.Contains({ i, j, k }) && isWrong(all.NumberOf(i, j, k)));
  };
  const VoxelNumbers numbers(map.Size);
  std::vector<std::int64_t> lost;
  for (const std::int64_t voxel : wrong)
  {
    const auto [i, j, k] = numbers.PlaceOf(voxel);
    if (isOfSide(i, j, k) && !isKept(i - 1, j, k) && !isKept(i + 1, j, k) &&
      !isKept(i, j - 1, k) && !isKept(i, j + 1, k) && !isKept(i, j, k - 1) &&
      !isKept(i, j, k + 1))
    {
      lost.push_back(voxel);
    }
  }
  return lost;
}

std::int64_t SizeOfLargestLostPart(
  const LabelMap& map, int object, const std::vector<std::int64_t>& wrong)
{
  const std::vector<std::int64_t> lost = FindLostVoxels(map, object, wrong, true);
  const VoxelNumbers numbers(map.Size);
  DisjointSets parts(lost.size());
  for (std::size_t n = 0; n < lost.size(); ++n)
  {
    const std::array<int, 3> place = numbers.PlaceOf(lost[n]);
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t before = lost[n] - numbers.Stride(axis);
      const auto found = std::lower_bound(lost.begin(), lost.end(), before);
      if (place[axis] > 0 && *found == before)
      {
        parts.Join(static_cast<int>(n), static_cast<int>(found - lost.begin()));
      }
    }
  }
  std::vector<std::int64_t> sizes(lost.size(), 0);
  std::int64_t largest = 0;
  for (std::size_t n = 0; n < lost.size(); ++n)
  {
    largest = std::max(largest, ++sizes[static_cast<std::size_t>(parts.Find(static_cast<int>(n)))]);
  }
  return largest;
}
}
