// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LongEdges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <unordered_map>

namespace volumic
{
namespace
{
class EdgeHalver
{
public:
  EdgeHalver(IndexedSurface& surface, double longest) : Surface(surface), Longest(longest) {}

  /** Whether there was an edge to halve. */
  bool Run()
  {
    const std::size_t olds = this->Surface.Triangles.size();
    for (std::size_t t = 0; t < olds; ++t)
    {
      this->Divide(t);
    }
    return !this->Middles.empty();
  }

private:
  double Length(int a, int b) const
  {
    const Point& p = this->Surface.Points[static_cast<std::size_t>(a)];
    const Point& q = this->Surface.Points[static_cast<std::size_t>(b)];
    return std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
  }

  /** The point halfway; -1 where the edge is not too long. Both triangles get the same. */
  int Middle(int a, int b)
  {
    if (!(this->Length(a, b) > this->Longest))
    {
      return -1;
    }
    const std::uint64_t key =
      static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
    auto [found, isNew] = this->Middles.emplace(key, static_cast<int>(this->Surface.Points.size()));
    if (isNew)
    {
      const Point p = this->Surface.Points[static_cast<std::size_t>(a)];
      const Point q = this->Surface.Points[static_cast<std::size_t>(b)];
      this->Surface.Points.push_back(
        { 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2]) });
    }
    return found->second;
  }

  void Divide(std::size_t t)
  {
    const Triangle corner = this->Surface.Triangles[t];
    std::array<int, 3> middle; // of the edge from each corner to the next
    int halved = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      middle[k] = this->Middle(corner[k], corner[(k + 1) % 3]);
      halved += middle[k] >= 0;
    }
    if (halved == 0)
    {
      return;
    }
    // Turned so that the first edge is halved and, of two, the last one too.
    std::size_t k = 0;
    while (middle[k] < 0 || (halved == 2 && middle[(k + 2) % 3] < 0))
    {
      ++k;
    }
    const int a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
    const int ab = middle[k], bc = middle[(k + 1) % 3], ca = middle[(k + 2) % 3];
    if (halved == 1)
    {
      this->Replace(t, { { a, ab, c }, { ab, b, c } });
    }
    else if (halved == 3)
    {
      this->Replace(t, { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
    }
    else if (this->Length(ab, c) < this->Length(b, ca))
    {
      this->Replace(t, { { a, ab, ca }, { ab, b, c }, { ab, c, ca } });
    }
    else
    {
      this->Replace(t, { { a, ab, ca }, { ab, b, ca }, { b, c, ca } });
    }
  }

  void Replace(std::size_t t, std::initializer_list<Triangle> parts)
  {
    this->Surface.Triangles[t] = *parts.begin();
    for (const Triangle* part = parts.begin() + 1; part != parts.end(); ++part)
    {
      this->Surface.Triangles.push_back(*part);
    }
  }

  IndexedSurface& Surface;
  double Longest;
  std::unordered_map<std::uint64_t, int> Middles;
};
}

void HalveLongEdges(IndexedSurface& surface, double longest)
{
  while (EdgeHalver(surface, longest).Run())
  {
  }
}
}
