// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceJudge.h"

#include "JudgeInternals.h"
#include "PointGrid.h"

#include <algorithm>
#include <limits>

namespace volumic::support
{
namespace
{

/** Relative tolerance of lengths, as points are rounded to float. */
constexpr double Rounding = 1e-6;
/** Longest edge by eq. 1, in delta. */
constexpr double LongestEdge = 2.5;
/** Vertices at least so many edges apart are a pair of eq. 1. */
constexpr int MinimumPairDistance = 4;
/** Minimum distance of a pair, in delta: the circumradius of the largest triangle. */
const double NearestInDelta = LongestEdge / std::sqrt(3.0);

void JudgePairs(const TriangleSurface& surface, const std::vector<std::pair<int, int>>& edges,
  const std::vector<double>& deltas, LengthVerdict& verdict)
{
  std::vector<std::vector<int>> neighbours(surface.Points.size());
  for (const auto& e : edges)
  {
    neighbours[e.first].push_back(e.second);
    neighbours[e.second].push_back(e.first);
  }
  const double largest = deltas.empty() ? 0.0 : *std::max_element(deltas.begin(), deltas.end());
  const PointGrid grid(surface.Points, NearestInDelta * largest);
  // near[v] == i: v is less than MinimumPairDistance edges from i.
  std::vector<int> near(surface.Points.size(), -1);
  std::vector<int> queue;
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    const int vertex = static_cast<int>(p);
    if (neighbours[p].empty())
    {
      continue; // unused point
    }
    queue.assign(1, vertex);
    near[p] = vertex;
    for (std::size_t steps = 1, done = 0; steps < MinimumPairDistance; ++steps)
    {
      for (const std::size_t end = queue.size(); done < end; ++done)
      {
        for (const int other : neighbours[queue[done]])
        {
          if (near[other] != vertex)
          {
            near[other] = vertex;
            queue.push_back(other);
          }
        }
      }
    }
    // A pair is counted at the vertex with the smaller delta, or the smaller index.
    grid.ForEachWithin(surface.Points[p], NearestInDelta * deltas[p] * (1.0 - Rounding),
      [&](int other)
      {
        const bool isCountedHere =
          deltas[other] > deltas[p] || (deltas[other] == deltas[p] && other > vertex);
        verdict.NearPairs += isCountedHere && near[other] != vertex && !neighbours[other].empty();
      });
  }
}

} // namespace

LengthVerdict JudgeLengths(const TriangleSurface& surface, double delta)
{
  return JudgeLengths(surface, std::vector<double>(surface.Points.size(), delta));
}

LengthVerdict JudgeLengths(const TriangleSurface& surface, const std::vector<double>& deltas)
{
  const std::vector<std::pair<int, int>> edges = UniqueEdges(surface);
  LengthVerdict verdict;
  verdict.Edges = edges.size();
  verdict.Shortest = edges.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const auto& e : edges)
  {
    const double length = Norm(Difference(surface.Points[e.first], surface.Points[e.second]));
    const double delta = 0.5 * (deltas[e.first] + deltas[e.second]);
    verdict.Shortest = std::min(verdict.Shortest, length);
    verdict.Longest = std::max(verdict.Longest, length);
    verdict.EdgesTooShort += length < delta * (1.0 - Rounding);
    verdict.EdgesTooLong += length > LongestEdge * delta * (1.0 + Rounding);
    sum += length;
  }
  if (!edges.empty())
  {
    verdict.Mean = sum / edges.size();
  }
  JudgePairs(surface, edges, deltas, verdict);
  return verdict;
}

ShapeVerdict JudgeShapes(const TriangleSurface& surface)
{
  std::vector<double> ratios;
  ratios.reserve(surface.Triangles.size());
  double sum = 0.0;
  for (const auto& t : surface.Triangles)
  {
    const std::array<double, 3> u = Difference(surface.Points[t[1]], surface.Points[t[0]]);
    const std::array<double, 3> v = Difference(surface.Points[t[2]], surface.Points[t[0]]);
    const double a = Norm(u), b = Norm(v);
    const double c = Norm(Difference(surface.Points[t[2]], surface.Points[t[1]]));
    const double area = 0.5 * Norm(Cross(u, v));
    const double product = a * b * c * 0.5 * (a + b + c);
    // r = area / s and R = a b c / (4 area), with s half of the perimeter.
    ratios.push_back(product > 0.0 ? 8.0 * area * area / product : 0.0);
    sum += ratios.back();
  }
  ShapeVerdict verdict;
  if (!ratios.empty())
  {
    verdict.Mean = sum / ratios.size();
    verdict.Least = *std::min_element(ratios.begin(), ratios.end());
    verdict.Quantile01 = Quantile(ratios, 0.01);
  }
  return verdict;
}

} // namespace volumic::support
