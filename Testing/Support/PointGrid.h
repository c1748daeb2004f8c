// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** Points sorted into cells, to find those near a place. Part of the judge. */

#ifndef volumicPointGrid_h
#define volumicPointGrid_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic::support
{

class PointGrid
{
public:
  /** Keeps a reference to the points. `radius` is the largest distance that will be asked for. */
  PointGrid(const std::vector<std::array<double, 3>>& points, double radius)
    : Points(points), CellSize(radius)
  {
    if (points.empty())
    {
      return;
    }
    std::array<double, 3> high = points[0];
    this->Low = points[0];
    for (const auto& p : points)
    {
      for (int a = 0; a < 3; ++a)
      {
        this->Low[a] = std::min(this->Low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
    // Points far apart must not cost memory: the cells grow until they are few enough.
    const double most = std::max(LeastCells, CellsPerPoint * points.size());
    for (;; this->CellSize *= CellGrowth)
    {
      double cells = 1.0;
      for (int a = 0; a < 3; ++a)
      {
        cells *= std::floor((high[a] - this->Low[a]) / this->CellSize) + 1.0;
      }
      if (cells <= most)
      {
        break;
      }
    }
    std::size_t cells = 1;
    for (int a = 0; a < 3; ++a)
    {
      this->Cells[a] = static_cast<int>((high[a] - this->Low[a]) / this->CellSize) + 1;
      cells *= static_cast<std::size_t>(this->Cells[a]);
    }
    // Counting sort: Start[c] .. Start[c + 1] are the members of cell c.
    this->Start.assign(cells + 1, 0);
    for (const auto& p : points)
    {
      ++this->Start[this->CellOf(p) + 1];
    }
    for (std::size_t c = 0; c < cells; ++c)
    {
      this->Start[c + 1] += this->Start[c];
    }
    this->Members.resize(points.size());
    std::vector<int> next(this->Start.begin(), this->Start.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      this->Members[next[this->CellOf(points[i])]++] = static_cast<int>(i);
    }
  }

  /**
   * Calls visit(index, squared distance) for every point within `radius` of the place; stops early
   * when it returns false. `radius` must not be over the one of the constructor.
   */
  template <typename Visitor>
  void ForEachWithin(const std::array<double, 3>& place, double radius, Visitor visit) const
  {
    if (this->Members.empty())
    {
      return;
    }
    int first[3], last[3];
    for (int a = 0; a < 3; ++a)
    {
      const double from = std::floor((place[a] - radius - this->Low[a]) / this->CellSize);
      const double to = std::floor((place[a] + radius - this->Low[a]) / this->CellSize);
      if (to < 0.0 || from >= this->Cells[a])
      {
        return;
      }
      first[a] = static_cast<int>(std::max(from, 0.0));
      last[a] = static_cast<int>(std::min(to, this->Cells[a] - 1.0));
    }
    for (int z = first[2]; z <= last[2]; ++z)
    {
      for (int y = first[1]; y <= last[1]; ++y)
      {
        const std::size_t row = this->Row(y, z);
        for (int m = this->Start[row + first[0]]; m < this->Start[row + last[0] + 1]; ++m)
        {
          const auto& p = this->Points[this->Members[m]];
          const double x = p[0] - place[0], dy = p[1] - place[1], dz = p[2] - place[2];
          const double squared = x * x + dy * dy + dz * dz;
          if (squared <= radius * radius && !visit(this->Members[m], squared))
          {
            return;
          }
        }
      }
    }
  }

private:
  /** What the number of cells is bounded by, and what cells grow by until it is. */
  static constexpr double LeastCells = 1e6;
  static constexpr double CellsPerPoint = 64.0;
  static constexpr double CellGrowth = 1.3;

  std::size_t Row(int y, int z) const
  {
    return (static_cast<std::size_t>(z) * this->Cells[1] + y) * this->Cells[0];
  }

  std::size_t CellOf(const std::array<double, 3>& p) const
  {
    int c[3];
    for (int a = 0; a < 3; ++a)
    {
      c[a] = std::min(static_cast<int>((p[a] - this->Low[a]) / this->CellSize), this->Cells[a] - 1);
    }
    return this->Row(c[1], c[2]) + c[0];
  }

  const std::vector<std::array<double, 3>>& Points;
  double CellSize;
  std::array<double, 3> Low = { 0.0, 0.0, 0.0 };
  std::array<int, 3> Cells = { 0, 0, 0 };
  std::vector<int> Start;
  std::vector<int> Members;
};

} // namespace volumic::support

#endif
