// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRowCrossing_h
#define volumicRowCrossing_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace volumic
{
/** Crossing of a line along x with a triangle, to sum up winding numbers. */
struct RowCrossing
{
  /** Change of the winding number along +x: 1 entering, -1 leaving, 0 without a crossing. */
  int Winding = 0;
  double X = 0.;

  /**
   * Compute the crossing with the line through (y, z). Only one of the two ends of an edge counts,
   * and both its triangles agree on it. A line therefore enters a closed surface as often as it
   * leaves it, even if it passes through edges and corners.
   */
  static RowCrossing Of(const Point& a, const Point& b, const Point& c, double y, double z)
  {
    RowCrossing crossing;
    crossing.Winding = EdgeSign(a, b, y, z) + EdgeSign(b, c, y, z) + EdgeSign(c, a, y, z);
    if (crossing.Winding == 0)
    {
      return crossing;
    }
    const double weight[3] = { TwiceArea(b, c, y, z), TwiceArea(c, a, y, z),
      TwiceArea(a, b, y, z) };
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
   * Return 1 if the edge passes above the line to the right, -1 if it does so to the left, else 0.
   * The view is along x, y points right and z up.
   */
  static int EdgeSign(const Point& from, const Point& to, double y, double z)
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

  /** Return twice the signed area of the triangle that the edge and the line span, seen along x. */
  static double TwiceArea(const Point& from, const Point& to, double y, double z)
  {
    return (to[1] - from[1]) * (z - from[2]) - (to[2] - from[2]) * (y - from[1]);
  }
};

/** Rows along x on a regular grid in y and z. */
struct RowGrid
{
  struct Crossing
  {
    std::int64_t Row; ///< See RowOf().
    RowCrossing Where;

    /** Order by row, then along it. */
    bool operator<(const Crossing& other) const
    {
      return this->Row != other.Row ? this->Row < other.Row : this->Where.X < other.Where.X;
    }
  };

  std::array<std::int64_t, 3> First = { 0, 0, 0 }; ///< Range of rows along y and z.
  std::array<std::int64_t, 3> End = { 0, 0, 0 };
  Point Origin = { 0., 0., 0. };
  double Pitch = 1.;

  double Coordinate(int axis, std::int64_t i) const
  {
    return this->Origin[axis] + this->Pitch * static_cast<double>(i);
  }
  std::int64_t RowOf(std::int64_t j, std::int64_t k) const
  {
    return (k - this->First[2]) * (this->End[1] - this->First[1]) + j - this->First[1];
  }
  /** Append the crossings of a triangle. Only rows near it are tested. */
  void AddCrossings(const std::array<Point, 3>& triangle, std::vector<Crossing>& crossings) const;
};

/** Points sorted by y, to find those near a triangle or a vertex without a full search. */
class SortedPoints
{
public:
  explicit SortedPoints(const std::vector<Point>& points) : Points(points), Order(points.size())
  {
    std::iota(this->Order.begin(), this->Order.end(), 0);
    std::sort(this->Order.begin(), this->Order.end(),
      [&](int a, int b) { return points[a][1] < points[b][1]; });
  }

  /** Call visit(index) for the points with low <= y <= high. */
  template <typename Visitor>
  void Visit(double low, double high, const Visitor& visit) const
  {
    auto at = std::lower_bound(this->Order.begin(), this->Order.end(), low,
      [this](int i, double y) { return this->Points[i][1] < y; });
    for (; at != this->Order.end() && this->Points[*at][1] <= high; ++at)
    {
      visit(*at);
    }
  }

private:
  const std::vector<Point>& Points;
  std::vector<int> Order;
};

/**
 * Return for each point the components that enclose it, in ascending order: a ray from it along x
 * crosses their faces an odd number of times. O(n + pairs of ray and face that overlap along y).
 * The result does not depend on the executor.
 * @param own component to ignore for each point, on which the point lies; empty if there is none
 * @param facesOf facesOf(begin, end, visit) calls visit(a, b, c, component) with the corners of the
 *   faces of a range of the n items
 */
template <typename FacesOf>
std::vector<std::vector<int>> EnclosingComponents(const std::vector<Point>& points,
  const std::vector<int>& own, std::size_t n, const FacesOf& facesOf, Executor& executor)
{
  constexpr std::size_t spanSize = 8192;
  using Crossing = std::pair<int, int>; // Index of the point, component.
  const auto keepOdd = [](std::vector<Crossing>& crossings)
  {
    std::sort(crossings.begin(), crossings.end());
    std::size_t count = 0; // Crossings that are not cancelled by an equal one yet.
    for (const Crossing& crossing : crossings)
    {
      const bool hasMet = count > 0 && crossings[count - 1] == crossing;
      count = hasMet ? count - 1 : count + 1;
      if (!hasMet)
      {
        crossings[count - 1] = crossing;
      }
    }
    crossings.resize(count);
  };
  const SortedPoints sorted(points);
  std::vector<std::vector<Crossing>> spans((n + spanSize - 1) / spanSize);
  ForSpans(executor, n, spanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      facesOf(begin, end,
        [&](const Point& a, const Point& b, const Point& c, int component)
        {
          const auto y = std::minmax({ a[1], b[1], c[1] });
          sorted.Visit(y.first, y.second,
            [&](int i)
            {
              if (own.empty() || own[i] != component)
              {
                const RowCrossing rowCrossing =
                  RowCrossing::Of(a, b, c, points[i][1], points[i][2]);
                if (rowCrossing.Winding != 0 && rowCrossing.X > points[i][0])
                {
                  spans[span].emplace_back(i, component);
                }
              }
            });
        });
      keepOdd(spans[span]);
    });
  std::vector<Crossing> crossings = Joined(executor, spans);
  keepOdd(crossings);
  std::vector<std::vector<int>> enclosing(points.size());
  for (const Crossing& crossing : crossings)
  {
    enclosing[crossing.first].push_back(crossing.second);
  }
  return enclosing;
}
}

#endif
