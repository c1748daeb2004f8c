// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRowCrossing_h
#define volumicRowCrossing_h

#include "Core/Common/IndexedSurface.h"

#include <algorithm>

namespace volumic
{
/**
 * Where a line along x crosses a triangle: what encloses a place is found by counting the crossings
 * on one side of it.
 */
struct RowCrossing
{
  /** By how much the winding number grows there: 1 into what is enclosed, -1 out of it, 0: none. */
  int Winding = 0;
  double X = 0.;

  /**
   * Of the line through (y, z). Of the two ends of an edge only one counts, and both its triangles
   * get the same answer from it, so that a line crosses a closed surface as often inward as
   * outward, even where it runs through edges and corners.
   */
  static RowCrossing Of(const Point& a, const Point& b, const Point& c, double y, double z)
  {
    RowCrossing crossing;
    crossing.Winding = Under(a, b, y, z) + Under(b, c, y, z) + Under(c, a, y, z);
    if (crossing.Winding == 0)
    {
      return crossing;
    }
    const double weight[3] = { Area(b, c, y, z), Area(c, a, y, z), Area(a, b, y, z) };
    const double sum = weight[0] + weight[1] + weight[2];
    const double x[3] = { a[0], b[0], c[0] };
    for (int k = 0; k < 3; ++k)
    {
      crossing.X += sum != 0. ? weight[k] / sum * x[k] : x[k] / 3.;
    }
    crossing.X =
      std::clamp(crossing.X, std::min({ a[0], b[0], c[0] }), std::max({ a[0], b[0], c[0] }));
    return crossing;
  }

private:
  /**
   * Seen along x, with y to the right and z up: 1 where the edge passes over the line to the right,
   * -1 where it does so to the left, 0 where it is not over it.
   */
  static int Under(const Point& from, const Point& to, double y, double z)
  {
    const bool right = to[1] > y;
    if ((from[1] > y) == right)
    {
      return 0;
    }
    const Point& low = right ? from : to;
    const Point& high = right ? to : from;
    if (!((high[1] - low[1]) * (z - low[2]) < (high[2] - low[2]) * (y - low[1])))
    {
      return 0;
    }
    return right ? 1 : -1;
  }

  /** Twice the signed area of the triangle of an edge and the line, seen along x. */
  static double Area(const Point& from, const Point& to, double y, double z)
  {
    return (to[1] - from[1]) * (z - from[2]) - (to[2] - from[2]) * (y - from[1]);
  }
};
}

#endif
