// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTransform.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace volumic
{
namespace
{
template <typename Map>
IndexedSurface Transform(const IndexedSurface& surface, bool isMirror, const Map& map)
{
  IndexedSurface transformed;
  transformed.Points.reserve(surface.Points.size());
  std::transform(surface.Points.begin(), surface.Points.end(),
    std::back_inserter(transformed.Points), map);
  transformed.Triangles = surface.Triangles;
  if (isMirror)
  {
    FlipOrientation(transformed);
  }
  return transformed;
}
}

void FlipOrientation(IndexedSurface& surface)
{
  for (Triangle& triangle : surface.Triangles)
  {
    std::swap(triangle[1], triangle[2]);
  }
}

IndexedSurface ToWorld(const IndexedSurface& surface, const Workspace& space)
{
  return Transform(
    surface, space.IsMirrored(), [&space](const Point& place) { return space.ToWorld(place); });
}

IndexedSurface ToWorkspace(const IndexedSurface& surface, const Workspace& space)
{
  return Transform(
    surface, space.IsMirrored(), [&space](const Point& place) { return space.ToWorkspace(place); });
}
}
