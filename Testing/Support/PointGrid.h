// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPointGrid_h
#define volumicPointGrid_h

#include "ForVoxels.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace volumic::support
{
/** Grid of points for range queries. */
class PointGrid
{
public:
  /** Keep a reference to the points. @param radius largest search radius */
  PointGrid(const std::vector<std::array<double, 3>>& points, double radius)
    : Points(points), Side(radius)
  {
    for (std::size_t p = 0; p < points.size(); ++p)
    {
      this->Cells[this->CellOf(points[p])].push_back(static_cast<int>(p));
    }
  }

  /** Call visit(index) for each point within a radius. */
  template <typename Visitor>
  void ForEachWithin(const std::array<double, 3>& centre, double radius, Visitor visit) const
  {
    const Cell middle = this->CellOf(centre);
    ForBox({ -1, -1, -1 }, { 2, 2, 2 },
      [&](int i, int j, int k)
      {
        const auto cell = this->Cells.find({ middle[0] + i, middle[1] + j, middle[2] + k });
        for (std::size_t n = 0; cell != this->Cells.end() && n < cell->second.size(); ++n)
        {
          const auto& p = this->Points[cell->second[n]];
          if (std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) <= radius)
          {
            visit(cell->second[n]);
          }
        }
      });
  }

private:
  using Cell = std::array<long long, 3>;

  struct Hash
  {
    std::size_t operator()(const Cell& c) const
    {
      return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
    }
  };

  Cell CellOf(const std::array<double, 3>& p) const
  {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = static_cast<long long>(std::floor(p[axis] / this->Side));
    }
    return cell;
  }

  const std::vector<std::array<double, 3>>& Points;
  double Side;
  std::unordered_map<Cell, std::vector<int>, Hash> Cells;
};
} // namespace volumic::support

#endif
