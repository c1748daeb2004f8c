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

/** Rows along x at regular places of y and z. */
struct RowGrid
{
  struct Crossing
  {
    std::int64_t Row; ///< see RowOf()
    RowCrossing Where;

    /** By row, and along it. */
    bool operator<(const Crossing& other) const
    {
      return this->Row != other.Row ? this->Row < other.Row : this->Where.X < other.Where.X;
    }
  };

  std::array<std::int64_t, 3> First = { 0, 0, 0 }; ///< of the rows along y and z
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
  /** Adds those of a triangle: each row, whatever its shape, is asked for where it is near only. */
  void AddCrossings(const std::array<Point, 3>& triangle, std::vector<Crossing>& crossings) const;
};

/** Places by y: what is near a triangle or a vertex is found without a search of all. */
class SortedPoints
{
public:
  explicit SortedPoints(const std::vector<Point>& places) : Places(places), Order(places.size())
  {
    std::iota(this->Order.begin(), this->Order.end(), 0);
    std::sort(this->Order.begin(), this->Order.end(),
      [&](int a, int b) { return places[a][1] < places[b][1]; });
  }

  /** Calls visit(index) for the places with low <= y <= high. */
  template <typename Visitor>
  void Visit(double low, double high, const Visitor& visit) const
  {
    auto at = std::lower_bound(this->Order.begin(), this->Order.end(), low,
      [this](int i, double y) { return this->Places[i][1] < y; });
    for (; at != this->Order.end() && this->Places[*at][1] <= high; ++at)
    {
      visit(*at);
    }
  }

private:
  const std::vector<Point>& Places;
  std::vector<int> Order;
};

/**
 * For each place the components about it, ascending: those of whose faces a ray from there along x
 * crosses an odd number. O(n + pairs of ray and face that overlap along y); the same for any
 * executor.
 * @param own the component that each place lies on, which does not count; empty: on none
 * @param facesOf facesOf(begin, end, visit) calls visit(a, b, c, component) with the corners of
 *                the faces of some of n items
 */
template <typename FacesOf>
std::vector<std::vector<int>> ComponentsAbout(const std::vector<Point>& places,
  const std::vector<int>& own, std::size_t n, const FacesOf& facesOf, Executor& executor)
{
  constexpr std::size_t spanSize = 8192;
  using Crossing = std::pair<int, int>; // of place and component
  const auto keepOdd = [](std::vector<Crossing>& crossings)
  {
    std::sort(crossings.begin(), crossings.end());
    std::size_t count = 0; // Of those that no equal one has met yet.
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
  const SortedPoints sorted(places);
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
                const RowCrossing where = RowCrossing::Of(a, b, c, places[i][1], places[i][2]);
                if (where.Winding != 0 && where.X > places[i][0])
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
  std::vector<std::vector<int>> about(places.size());
  for (const Crossing& crossing : crossings)
  {
    about[crossing.first].push_back(crossing.second);
  }
  return about;
}
}

#endif
