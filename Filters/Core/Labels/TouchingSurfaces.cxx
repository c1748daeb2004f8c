// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/TouchingSurfaces.h"

#include "Core/Common/Spans.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>

namespace volumic
{
namespace
{
/** What is nearer touches, in voxels: it could meet when written with other coordinates. */
constexpr double Tolerance = 1e-4;

bool Overlap(const Bounds& a, const Bounds& b)
{
  bool overlap = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    overlap = overlap && a.Low[axis] <= b.High[axis] + Tolerance &&
      b.Low[axis] <= a.High[axis] + Tolerance;
  }
  return overlap;
}
}

std::vector<std::vector<int>> FindTouching(
  const std::vector<IndexedSurface>& surfaces, Executor& executor)
{
  const std::size_t count = surfaces.size();
  std::vector<Bounds> bounds(count);
  std::vector<std::unique_ptr<TriangleTree>> trees(count);
  ForSpans(executor, count, 1,
    [&](std::size_t i, std::size_t, std::size_t)
    {
      bounds[i] = Bounds::Of(surfaces[i]);
      trees[i] = std::make_unique<TriangleTree>(surfaces[i]);
    });
  std::vector<std::vector<int>> touching(count);
  ForSpans(executor, count, 1,
    [&](std::size_t i, std::size_t, std::size_t)
    {
      std::vector<int>& found = touching[i];
      for (std::size_t other = 0; other < count; ++other)
      {
        if (other != i && Overlap(bounds[i], bounds[other]))
        {
          const std::vector<int> more =
            FindIntersecting(surfaces[i], surfaces[other], *trees[other], Tolerance);
          found.insert(found.end(), more.begin(), more.end());
        }
      }
      std::sort(found.begin(), found.end());
      found.erase(std::unique(found.begin(), found.end()), found.end());
    });
  return touching;
}
}
