// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/RowCrossing.h"

#include <cmath>
#include <limits>

namespace volumic
{
void RowGrid::AddCrossings(
  const std::array<Point, 3>& triangle, std::vector<Crossing>& crossings) const
{
  constexpr double rounding = 1e-6; // In spacings, as a margin for rounding.
  const auto first = [this](int axis, double from)
  {
    const double index = (from - this->Coordinate(axis, 0)) / this->Pitch;
    return std::max(static_cast<std::int64_t>(std::ceil(index - rounding)), this->First[axis]);
  };
  const auto [bottom, top] = std::minmax({ triangle[0][2], triangle[1][2], triangle[2][2] });
  for (std::int64_t k = first(2, bottom); k < this->End[2]; ++k)
  {
    const double z = this->Coordinate(2, k);
    if (z > top + rounding * this->Pitch)
    {
      break;
    }
    // Range along y of the section of the triangle at z.
    double low = std::numeric_limits<double>::max();
    double high = -low;
    for (int c = 0; c < 3; ++c)
    {
      const Point& a = triangle[c];
      const Point& b = triangle[(c + 1) % 3];
      const double fraction = a[2] != b[2] ? std::clamp((z - a[2]) / (b[2] - a[2]), 0., 1.) : 0.;
      if ((a[2] - z) * (b[2] - z) <= 0. || fraction == 0. || fraction == 1.)
      {
        low = std::min(low, a[1] + fraction * (b[1] - a[1]));
        high = std::max(high, a[1] + fraction * (b[1] - a[1]));
      }
    }
    for (std::int64_t j = first(1, low); j < this->End[1]; ++j)
    {
      const double y = this->Coordinate(1, j);
      if (y > high + rounding * this->Pitch)
      {
        break;
      }
      const RowCrossing crossing = RowCrossing::Of(triangle[0], triangle[1], triangle[2], y, z);
      if (crossing.Winding != 0)
      {
        crossings.push_back({ this->RowOf(j, k), crossing });
      }
    }
  }
}
}
