// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MisclassifiedVoxels.h"

#include <algorithm>
#include <cmath>

namespace volumic::support
{

std::vector<char> EnclosedVoxels(const TriangleSurface& surface, const std::array<int, 3>& size)
{
  const auto [nx, ny, nz] = size;
  // Crossings with rows of voxels. Rows are shifted slightly so that they hit no edge.
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(ny) * nz);
  constexpr double dy = 1.234567e-7;
  constexpr double dz = 2.345678e-7;
  for (const auto& triangle : surface.Triangles)
  {
    const auto& a = surface.Points[triangle[0]];
    const auto& b = surface.Points[triangle[1]];
    const auto& c = surface.Points[triangle[2]];
    const auto range = [&](int axis, double shift, int n)
    {
      const auto limits = std::minmax({ a[axis], b[axis], c[axis] });
      return std::make_pair(std::max(0, static_cast<int>(std::ceil(limits.first - shift))),
        std::min(n - 1, static_cast<int>(std::floor(limits.second - shift))));
    };
    const auto rows = range(1, dy, ny);
    const auto slices = range(2, dz, nz);
    for (int k = slices.first; k <= slices.second; ++k)
    {
      for (int j = rows.first; j <= rows.second; ++j)
      {
        const double y = j + dy;
        const double z = k + dz;
        const auto side = [&](const std::array<double, 3>& p, const std::array<double, 3>& q)
        { return (q[1] - p[1]) * (z - p[2]) - (q[2] - p[2]) * (y - p[1]); };
        const double u = side(b, c);
        const double v = side(c, a);
        const double w = side(a, b);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))
        {
          crossings[static_cast<std::size_t>(k) * ny + j].push_back(
            (u * a[0] + v * b[0] + w * c[0]) / (u + v + w));
        }
      }
    }
  }
  std::vector<char> enclosed(static_cast<std::size_t>(nx) * ny * nz);
  std::size_t index = 0;
  for (auto& row : crossings)
  {
    std::sort(row.begin(), row.end());
    auto next = row.begin();
    bool isInside = false;
    for (int i = 0; i < nx; ++i, ++index)
    {
      for (; next != row.end() && *next < i; ++next)
      {
        isInside = !isInside;
      }
      enclosed[index] = isInside;
    }
  }
  return enclosed;
}

double MisclassifiedFraction(const TriangleSurface& surface, const Scene& scene)
{
  const std::vector<char> enclosed = EnclosedVoxels(surface, scene.Size);
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < enclosed.size(); ++v)
  {
    wrong += (enclosed[v] != 0) != (scene.Inside[v] != 0);
  }
  const auto object = std::count(scene.Inside.begin(), scene.Inside.end(), 1);
  return static_cast<double>(wrong) / static_cast<double>(object);
}

} // namespace volumic::support
