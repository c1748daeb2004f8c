// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRowCrossing_h
#define volumicRowCrossing_h

#include "Core/Common/IndexedSurface.h"

#include <algorithm>
#include <utility>

namespace volumic
{
/** Where a line along x passes a triangle. */
struct RowCrossing
{
  int Turn = 0; ///< 1 into what the surface encloses, -1 out of it, 0: it passes by.
  double X = 0.;

  /**
   * Of the line through (y, z). An edge gives the two triangles at it the same number, so that a
   * line passes a closed surface as often inward as outward, also where it hits an edge; only at a
   * corner may rounding spoil that.
   */
  static RowCrossing Of(const IndexedSurface& surface, const Triangle& triangle, double y, double z)
  {
    double side[3];
    int left = 0;
    for (int k = 0; k < 3; ++k)
    {
      int from = triangle[(k + 1) % 3];
      int to = triangle[(k + 2) % 3];
      const bool swapped = from > to;
      if (swapped)
      {
        std::swap(from, to);
      }
      const Point& p = surface.Points[from];
      const Point& q = surface.Points[to];
      side[k] = (q[1] - p[1]) * (z - p[2]) - (q[2] - p[2]) * (y - p[1]);
      left += (side[k] >= 0.) != swapped;
      side[k] = swapped ? -side[k] : side[k];
    }
    RowCrossing crossing;
    if (left == 1 || left == 2)
    {
      return crossing;
    }
    crossing.Turn = left == 3 ? -1 : 1;
    const double sum = side[0] + side[1] + side[2];
    double low = surface.Points[triangle[0]][0];
    double high = low;
    for (int k = 0; k < 3; ++k)
    {
      const double x = surface.Points[triangle[k]][0];
      low = std::min(low, x);
      high = std::max(high, x);
      crossing.X += sum != 0. ? side[k] / sum * x : x / 3.;
    }
    crossing.X = std::clamp(crossing.X, low, high);
    return crossing;
  }
};
}

#endif
