// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/TriangleDistance.h"

#include <algorithm>
#include <limits>

namespace volumic
{
namespace
{
double SquaredDistanceToSegment(const VectorD& p, const VectorD& a, const VectorD& b)
{
  const VectorD along = b - a;
  const double length = SquaredLength(along);
  const double fraction = length > 0. ? std::clamp(Dot(p - a, along) / length, 0., 1.) : 0.;
  return SquaredLength(p - a - along * fraction);
}

double SquaredDistanceOfSegments(
  const VectorD& a, const VectorD& b, const VectorD& c, const VectorD& d)
{
  // Nearest points of the two lines if they lie within both segments, else at an end.
  const VectorD first = b - a;
  const VectorD second = d - c;
  const double ff = SquaredLength(first);
  const double ss = SquaredLength(second);
  const double fs = Dot(first, second);
  const double squaredArea = ff * ss - fs * fs;
  if (squaredArea > 0.)
  {
    const VectorD between = c - a;
    const double s = (Dot(first, between) * ss - Dot(second, between) * fs) / squaredArea;
    const double t = (Dot(first, between) * fs - Dot(second, between) * ff) / squaredArea;
    if (s >= 0. && s <= 1. && t >= 0. && t <= 1.)
    {
      return SquaredLength(between + second * t - first * s);
    }
  }
  return std::min({ SquaredDistanceToSegment(a, c, d), SquaredDistanceToSegment(b, c, d),
    SquaredDistanceToSegment(c, a, b), SquaredDistanceToSegment(d, a, b) });
}
}

double SquaredDistanceToTriangle(const VectorD& p, const VectorD* t)
{
  // The projection on the plane if it lies in the triangle, else the nearest point of an edge.
  const VectorD normal = Cross(t[1] - t[0], t[2] - t[0]);
  const double squaredArea = SquaredLength(normal);
  bool inside = squaredArea > 0.;
  for (int k = 0; k < 3 && inside; ++k)
  {
    inside = Dot(Cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0.;
  }
  if (inside)
  {
    const double height = Dot(normal, p - t[0]);
    return height * height / squaredArea;
  }
  return std::min({ SquaredDistanceToSegment(p, t[0], t[1]),
    SquaredDistanceToSegment(p, t[1], t[2]), SquaredDistanceToSegment(p, t[2], t[0]) });
}

double SquaredGapBetween(const MeshTriangle& f, const MeshTriangle& g)
{
  const auto has = [](const MeshTriangle& triangle, int v)
  { return std::find(triangle.Vertex, triangle.Vertex + 3, v) != triangle.Vertex + 3; };
  bool isInG[3];
  double nearest = std::numeric_limits<double>::max();
  for (int k = 0; k < 3; ++k)
  {
    isInG[k] = has(g, f.Vertex[k]);
    nearest =
      isInG[k] ? nearest : std::min(nearest, SquaredDistanceToTriangle(f.Corner[k], g.Corner));
    nearest = has(f, g.Vertex[k])
      ? nearest
      : std::min(nearest, SquaredDistanceToTriangle(g.Corner[k], f.Corner));
  }
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    for (int l = 0; l < 3; ++l)
    {
      const int ends[2] = { g.Vertex[l], g.Vertex[(l + 1) % 3] };
      const auto isEnd = [&](int v) { return v == ends[0] || v == ends[1]; };
      if ((isInG[k] && isEnd(f.Vertex[k])) || (isInG[next] && isEnd(f.Vertex[next])))
      {
        continue;
      }
      nearest = std::min(nearest,
        SquaredDistanceOfSegments(f.Corner[k], f.Corner[next], g.Corner[l], g.Corner[(l + 1) % 3]));
    }
  }
  return nearest;
}
}
