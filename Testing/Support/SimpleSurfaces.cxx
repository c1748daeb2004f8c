// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SimpleSurfaces.h"

#include <cmath>
#include <utility>

namespace volumic::support
{

TriangleSurface Tetrahedron(double size, const std::array<double, 3>& at)
{
  TriangleSurface surface;
  surface.Points = { at, { at[0] + size, at[1], at[2] }, { at[0], at[1] + size, at[2] },
    { at[0], at[1], at[2] + size } };
  surface.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
  return surface;
}

TriangleSurface Reversed(TriangleSurface surface)
{
  for (auto& t : surface.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  return surface;
}

void Append(TriangleSurface& to, const TriangleSurface& from)
{
  const int offset = static_cast<int>(to.Points.size());
  to.Points.insert(to.Points.end(), from.Points.begin(), from.Points.end());
  for (const auto& t : from.Triangles)
  {
    to.Triangles.push_back({ t[0] + offset, t[1] + offset, t[2] + offset });
  }
}

TriangleSurface Torus(int n, int m, double major, double minor)
{
  TriangleSurface surface;
  for (int i = 0; i < n; ++i)
  {
    const double u = 6.283185307179586 * i / n;
    for (int j = 0; j < m; ++j)
    {
      const double v = 6.283185307179586 * j / m;
      const double ring = major + minor * std::cos(v);
      surface.Points.push_back({ ring * std::cos(u), ring * std::sin(u), minor * std::sin(v) });
      const int a = i * m + j, b = ((i + 1) % n) * m + j;
      const int c = ((i + 1) % n) * m + (j + 1) % m, d = i * m + (j + 1) % m;
      surface.Triangles.push_back({ a, b, c });
      surface.Triangles.push_back({ a, c, d });
    }
  }
  return surface;
}

TriangleSurface Sheet(int n, double height)
{
  TriangleSurface surface;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      surface.Points.push_back({ 1.0 * i, 1.0 * j, height });
      if (i < n && j < n)
      {
        const int a = j * (n + 1) + i;
        surface.Triangles.push_back({ a, a + 1, a + n + 2 });
        surface.Triangles.push_back({ a, a + n + 2, a + n + 1 });
      }
    }
  }
  return surface;
}

} // namespace volumic::support
