// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTouchingSurfaces_h
#define volumicTouchingSurfaces_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <cstddef>
#include <vector>

namespace volumic
{
/** A triangle of one of some surfaces. */
struct SurfaceTriangle
{
  std::size_t Surface;
  int Triangle;

  bool operator<(const SurfaceTriangle& other) const
  {
    return this->Surface != other.Surface ? this->Surface < other.Surface
                                          : this->Triangle < other.Triangle;
  }
  bool operator==(const SurfaceTriangle& other) const
  {
    return this->Surface == other.Surface && this->Triangle == other.Triangle;
  }
};

/**
 * Where each of some closed surfaces meets others, sorted: its own triangles that touch or cross
 * another one, by exact tests, and all those of others' components that it has inside without that.
 * @param surfaces in coordinates in which voxel (i, j, k) of the map is at (i, j, k)
 */
std::vector<std::vector<SurfaceTriangle>> FindTouching(
  const std::vector<IndexedSurface>& surfaces, Executor& executor);
}

#endif
