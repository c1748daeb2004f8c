// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What the parts of the judge share. Include SurfaceJudge.h instead. */

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

/** Throws std::invalid_argument for what the contract of SurfaceJudge.h forbids. */
void CheckSurface(const TriangleSurface& surface);

/** Every edge once, as a sorted list of pairs with the smaller index first. */
std::vector<std::pair<int, int>> UniqueEdges(const TriangleSurface& surface);

/** `share` of the values lie under the result; reorders them. 0 without values. */
double Quantile(std::vector<double>& values, double share);
} // namespace volumic::support

#endif
