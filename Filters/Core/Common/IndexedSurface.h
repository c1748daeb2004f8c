// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicIndexedSurface_h
#define volumicIndexedSurface_h

#include <array>
#include <vector>

namespace volumic
{
using Point = std::array<double, 3>;
using Triangle = std::array<int, 3>;

/** An indexed triangle mesh, in whatever space its owner says. */
struct IndexedSurface
{
  std::vector<Point> Points;
  std::vector<Triangle> Triangles; ///< Counter-clockwise seen from outside.
};
}

#endif
