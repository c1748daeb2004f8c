// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicIndexedSurface_h
#define volumicIndexedSurface_h

#include "Core/Common/ScratchMemory.h"

#include <algorithm>
#include <array>
#include <limits>

namespace volumic
{
using Point = std::array<double, 3>;
using Triangle = std::array<int, 3>;

/** Indexed triangle mesh. Its owner defines the coordinate space. */
struct IndexedSurface
{
  LargeVector<Point> Points;
  LargeVector<Triangle> Triangles; ///< Counter-clockwise seen from outside.
};

/** Axis-aligned box; empty until a point is added. */
struct Bounds
{
  static constexpr double Most = std::numeric_limits<double>::max();
  Point Low = { Most, Most, Most };
  Point High = { -Most, -Most, -Most };

  void Add(const Point& p)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Low[k] = std::min(this->Low[k], p[k]);
      this->High[k] = std::max(this->High[k], p[k]);
    }
  }

  /** Return the bounds of all triangles. Unused points are ignored. */
  static Bounds Of(const IndexedSurface& surface)
  {
    Bounds bounds;
    for (const Triangle& t : surface.Triangles)
    {
      for (int corner : t)
      {
        bounds.Add(surface.Points[corner]);
      }
    }
    return bounds;
  }
};
}

#endif
