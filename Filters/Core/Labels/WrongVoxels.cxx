// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/WrongVoxels.h"

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
/**
 * A whole number near the surface, along an axis: what is reckoned from there is the same wherever
 * the map begins.
 */
double NearSurface(const IndexedSurface& surface, int axis)
{
  return surface.Points.empty() ? 0. : std::floor(surface.Points.front()[axis]);
}

/** Of all rows of the map, sorted; X from NearSurface() on. */
std::vector<RowGrid::Crossing> FindCrossings(const RowGrid& rows, const IndexedSurface& surface)
{
  const double base = NearSurface(surface, 0);
  std::vector<RowGrid::Crossing> crossings;
  for (const Triangle& t : surface.Triangles)
  {
    std::array<Point, 3> corners;
    for (int c = 0; c < 3; ++c)
    {
      corners[c] = surface.Points[static_cast<std::size_t>(t[c])];
      corners[c][0] -= base;
    }
    rows.AddCrossings(corners, crossings);
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}
}

std::vector<std::int64_t> FindWrongVoxels(
  const LabelBricks& bricks, int object, const IndexedSurface& surface, const VoxelBox& within)
{
  const LabelMap& map = bricks.Map();
  RowGrid rows;
  std::copy(map.Size().begin(), map.Size().end(), rows.End.begin());
  const std::vector<RowGrid::Crossing> crossings = FindCrossings(rows, surface);
  const double base = NearSurface(surface, 0);
  VoxelBox box = bricks.ExtentOf(object).Bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    // A surface stays within the field's box, which is larger by a brick.
    box.First[axis] = std::max(within.First[axis], (box.First[axis] - 1) * LabelBricks::Side);
    box.End[axis] = std::min(within.End[axis], (box.End[axis] + 1) * LabelBricks::Side);
  }
  std::vector<std::int64_t> wrong;
  const VoxelBox all = VoxelBox::Of(map.Size());
  for (int k = box.First[2]; k < box.End[2]; ++k)
  {
    for (int j = box.First[1]; j < box.End[1]; ++j)
    {
      const std::int64_t row = rows.RowOf(j, k);
      auto next = std::lower_bound(crossings.begin(), crossings.end(), row,
        [](const RowGrid::Crossing& crossing, std::int64_t number)
        { return crossing.Row < number; });
      const std::int64_t start = all.NumberOf(0, j, k);
      int winding = 0;
      for (int i = box.First[0]; i < box.End[0]; ++i)
      {
        for (; next != crossings.end() && next->Row == row && next->Where.X < i - base; ++next)
        {
          winding += next->Where.Winding;
        }
        const bool isObject = map.At(i, j, k) == object;
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
  const VoxelNumbers numbers(map.Size());
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
}
