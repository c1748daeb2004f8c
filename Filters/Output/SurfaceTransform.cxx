// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/SurfaceTransform.h"

#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** Points and triangles that one thread transforms at a time. */
constexpr std::size_t PointSpan = 16384;

template <typename Map>
void Transform(IndexedSurface& surface, bool isMirror, const Map& map, Executor& executor)
{
  ForSpans(executor, surface.Points.size(), PointSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        surface.Points[p] = map(surface.Points[p]);
      }
    });
  if (isMirror)
  {
    FlipOrientation(surface, executor);
  }
}
}

void FlipOrientation(IndexedSurface& surface, Executor& executor)
{
  ForSpans(executor, surface.Triangles.size(), PointSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        std::swap(surface.Triangles[t][1], surface.Triangles[t][2]);
      }
    });
}

IndexedSurface ToWorld(IndexedSurface surface, const Workspace& space, Executor& executor)
{
  Transform(
    surface, space.IsMirrored(), [&space](const Point& place) { return space.ToWorld(place); },
    executor);
  return surface;
}

IndexedSurface ToWorkspace(IndexedSurface surface, const Workspace& space, Executor& executor)
{
  Transform(
    surface, space.IsMirrored(), [&space](const Point& place) { return space.ToWorkspace(place); },
    executor);
  return surface;
}
}
