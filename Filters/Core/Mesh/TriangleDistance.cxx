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

/** Return the distance of two segments if the nearest points are no ends, otherwise a negative
 * value. */
double SquaredDistanceBetweenEnds(
  const VectorD& a, const VectorD& b, const VectorD& c, const VectorD& d)
{
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
  return -1.;
}

/** Return the distance of a point from a plane if its projection is in a triangle, otherwise < 0.
 */
double SquaredHeightAbove(const VectorD& p, const VectorD* t)
{
  const VectorD normal = Cross(t[1] - t[0], t[2] - t[0]);
  const double squaredArea = SquaredLength(normal);
  bool inside = squaredArea > 0.;
  for (int k = 0; k < 3 && inside; ++k)
  {
    inside = Dot(Cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0.;
  }
  const double height = Dot(normal, p - t[0]);
  return inside ? height * height / squaredArea : -1.;
}

/** The distances of corners of a triangle from edges of another one, each computed when needed. */
class CornerDistances
{
public:
  CornerDistances(const VectorD* corners, const VectorD* other) : Corners(corners), Other(other) {}

  double ToEdge(int corner, int edge)
  {
    double& known = this->Known[corner][edge];
    if (known < 0.)
    {
      known = SquaredDistanceToSegment(
        this->Corners[corner], this->Other[edge], this->Other[(edge + 1) % 3]);
    }
    return known;
  }

  double ToTriangle(int corner)
  {
    const double height = SquaredHeightAbove(this->Corners[corner], this->Other);
    return height >= 0.
      ? height
      : std::min({ this->ToEdge(corner, 0), this->ToEdge(corner, 1), this->ToEdge(corner, 2) });
  }

private:
  const VectorD* Corners;
  const VectorD* Other;
  double Known[3][3] = { { -1., -1., -1. }, { -1., -1., -1. }, { -1., -1., -1. } };
};
}

double SquaredDistanceToTriangle(const VectorD& p, const VectorD* t)
{
  return CornerDistances(&p, t).ToTriangle(0);
}

double SquaredGapBetween(const MeshTriangle& f, const MeshTriangle& g)
{
  const auto has = [](const MeshTriangle& triangle, int v)
  { return std::find(triangle.Vertex, triangle.Vertex + 3, v) != triangle.Vertex + 3; };
  CornerDistances ofF(f.Corner, g.Corner);
  CornerDistances ofG(g.Corner, f.Corner);
  bool isInG[3];
  double nearest = std::numeric_limits<double>::max();
  for (int k = 0; k < 3; ++k)
  {
    isInG[k] = has(g, f.Vertex[k]);
    nearest = isInG[k] ? nearest : std::min(nearest, ofF.ToTriangle(k));
    nearest = has(f, g.Vertex[k]) ? nearest : std::min(nearest, ofG.ToTriangle(k));
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
      const int end = (l + 1) % 3;
      const double between =
        SquaredDistanceBetweenEnds(f.Corner[k], f.Corner[next], g.Corner[l], g.Corner[end]);
      nearest = between >= 0. ? std::min(nearest, between)
                              : std::min({ nearest, ofF.ToEdge(k, l), ofF.ToEdge(next, l),
                                  ofG.ToEdge(l, k), ofG.ToEdge(end, k) });
    }
  }
  return nearest;
}
}
