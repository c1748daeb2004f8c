// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJudgeInternals_h
#define volumicJudgeInternals_h

#include "TriangleSurface.h"

#include <cmath>
#include <utility>
#include <vector>

namespace volumic::support
{

inline std::array<double, 3> Difference(
  const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

inline double Dot(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline std::array<double, 3> Cross(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

inline double Norm(const std::array<double, 3>& a)
{
  return std::sqrt(Dot(a, a));
}

inline std::array<double, 3> CentroidOf(
  const TriangleSurface& surface, const std::array<int, 3>& triangle)
{
  std::array<double, 3> centroid = { 0.0, 0.0, 0.0 };
  for (const int corner : triangle)
  {
    for (int a = 0; a < 3; ++a)
    {
      centroid[a] += surface.Points[corner][a] / 3.0;
    }
  }
  return centroid;
}

/** Return the sorted edges, each once, the smaller index first. */
std::vector<std::pair<int, int>> UniqueEdges(const TriangleSurface& surface);

/** Return a quantile of the values (0 if empty). Reorders the values. */
double Quantile(std::vector<double>& values, double fraction);
} // namespace volumic::support

#endif
