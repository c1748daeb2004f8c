// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "JudgeInternals.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace volumic::support
{
namespace
{

using Point = std::array<double, 3>;
using Triangle = std::array<int, 3>;

/**
 * In a generic rotation: then hardly anything lies straight above anything else. What still
 * does is told apart by Covers.
 */
Point Rotated(const Point& p)
{
  // About z, then about x, by the angles of the triangle of sides 3, 4, 5.
  return { 0.8 * p[0] - 0.6 * p[1], 0.6 * (0.6 * p[0] + 0.8 * p[1]) - 0.8 * p[2],
    0.8 * (0.6 * p[0] + 0.8 * p[1]) + 0.6 * p[2] };
}

/**
 * Twice the area of a, b and the place, seen from above; the same number with the opposite sign
 * for b, a, so that neighbouring triangles agree about the edge between them.
 */
double Side(const Point& a, const Point& b, const Point& place)
{
  if (a > b)
  {
    return -Side(b, a, place);
  }
  return (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0]);
}

/**
 * 1 or -1 where the triangle lies above the place, by the way it runs round; else 0. Of the
 * triangles on both sides of an edge, one takes what lies exactly on it.
 */
int Covers(const Point& a, const Point& b, const Point& c, const Point& place)
{
  const auto inside = [](double side, const Point& from, const Point& to)
  { return side > 0.0 || (side == 0.0 && from < to); };
  const double ab = Side(a, b, place), bc = Side(b, c, place), ca = Side(c, a, place);
  const bool first = inside(ab, a, b);
  if (inside(bc, b, c) != first || inside(ca, c, a) != first)
  {
    return 0;
  }
  const double sum = ab + bc + ca;
  if (sum == 0.0)
  {
    return 0;
  }
  const double height = (bc * a[2] + ca * b[2] + ab * c[2]) / sum;
  return height > place[2] ? (first ? 1 : -1) : 0;
}

/** Triangles sorted into the columns of a grid, seen from above. */
class Columns
{
public:
  Columns(const std::vector<Point>& points, const std::vector<Triangle>& triangles)
    : Number(std::max(1, static_cast<int>(std::sqrt(triangles.size() / 4.0))))
  {
    this->Low = this->High = points[triangles[0][0]];
    for (const Triangle& t : triangles)
    {
      for (const int v : t)
      {
        for (int a = 0; a < 2; ++a)
        {
          this->Low[a] = std::min(this->Low[a], points[v][a]);
          this->High[a] = std::max(this->High[a], points[v][a]);
        }
      }
    }
    this->Members.resize(static_cast<std::size_t>(this->Number) * this->Number);
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      int from[2], to[2];
      for (int a = 0; a < 2; ++a)
      {
        const double p = points[triangles[t][0]][a], q = points[triangles[t][1]][a],
                     r = points[triangles[t][2]][a];
        from[a] = this->Cell(std::min({ p, q, r }), a);
        to[a] = this->Cell(std::max({ p, q, r }), a);
      }
      for (int y = from[1]; y <= to[1]; ++y)
      {
        for (int x = from[0]; x <= to[0]; ++x)
        {
          this->Members[static_cast<std::size_t>(y) * this->Number + x].push_back(
            static_cast<int>(t));
        }
      }
    }
  }

  const std::vector<int>& At(const Point& place) const
  {
    return this->Members[static_cast<std::size_t>(this->Cell(place[1], 1)) * this->Number +
      this->Cell(place[0], 0)];
  }

private:
  int Cell(double x, int a) const
  {
    const double extent = this->High[a] - this->Low[a];
    const double relative = extent > 0.0 ? (x - this->Low[a]) / extent : 0.0;
    return std::clamp(static_cast<int>(relative * this->Number), 0, this->Number - 1);
  }

  int Number;
  Point Low, High;
  std::vector<std::vector<int>> Members;
};

} // namespace

std::vector<int> NestingDepths(const std::vector<Point>& places,
  const std::vector<Triangle>& triangles, const std::vector<int>& component,
  const std::vector<char>& sound)
{
  std::vector<int> depths(sound.size(), 0);
  if (sound.size() < 2)
  {
    return depths;
  }
  std::vector<Point> points;
  points.reserve(places.size());
  for (const Point& p : places)
  {
    points.push_back(Rotated(p));
  }
  std::vector<int> witness(sound.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    witness[component[t]] = triangles[t][0];
  }
  const Columns columns(points, triangles);
  for (std::size_t c = 0; c < sound.size(); ++c)
  {
    const Point& place = points[witness[c]];
    std::map<int, int> winding;
    for (const int t : columns.At(place))
    {
      const Triangle& corners = triangles[t];
      if (component[t] != static_cast<int>(c) && sound[component[t]])
      {
        winding[component[t]] +=
          Covers(points[corners[0]], points[corners[1]], points[corners[2]], place);
      }
    }
    depths[c] = static_cast<int>(std::count_if(
      winding.begin(), winding.end(), [](const auto& entry) { return entry.second != 0; }));
  }
  return depths;
}

} // namespace volumic::support
