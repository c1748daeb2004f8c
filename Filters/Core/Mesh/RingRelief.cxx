// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/RingRelief.h"

#include "Core/Mesh/SurfaceMesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace volumic
{
namespace
{
/** Cosine of the angle that a new triangle may turn from the old ones at most. */
constexpr double LeastCosine = 0.2;
/** Neighbours that each end of a flipped edge must keep. */
constexpr int LeastValence = 4;

std::uint64_t EdgeKey(int a, int b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint32_t>(std::max(a, b));
}

/** Flips edges of a surface, whose triangles about full points it keeps at hand. */
class RingReliever
{
public:
  explicit RingReliever(IndexedSurface& surface)
    : Surface(surface), Valence(surface.Points.size(), 0)
  {
    for (const Triangle& t : surface.Triangles)
    {
      for (const int corner : t)
      {
        ++this->Valence[static_cast<std::size_t>(corner)];
      }
    }
    for (std::size_t v = 0; v < this->Valence.size(); ++v)
    {
      if (this->Valence[v] > Ring::Capacity)
      {
        this->Full.push_back(static_cast<int>(v));
      }
    }
  }

  bool Run()
  {
    if (this->Full.empty())
    {
      return true;
    }
    std::unordered_set<int> isFull(this->Full.begin(), this->Full.end());
    for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
    {
      const Triangle& corners = this->Surface.Triangles[t];
      for (int k = 0; k < 3; ++k)
      {
        this->Edges.insert(EdgeKey(corners[k], corners[(k + 1) % 3]));
        if (isFull.count(corners[k]) != 0)
        {
          this->About[corners[k]].push_back(t);
        }
      }
    }
    return std::all_of(
      this->Full.begin(), this->Full.end(), [this](int v) { return this->Relieve(v); });
  }

private:
  struct Flip
  {
    std::size_t First;  ///< the triangle (v, w, a)
    std::size_t Second; ///< the triangle (w, v, b)
    int W;
    int A;
    int B;
    double Cosine = LeastCosine;
    bool IsFound = false;
  };

  bool Relieve(int v)
  {
    while (this->Valence[static_cast<std::size_t>(v)] > Ring::Capacity)
    {
      const Flip best = this->FindFlip(v);
      if (!best.IsFound)
      {
        return false;
      }
      this->Do(v, best);
    }
    return true;
  }

  /** The corner after v. */
  static int After(const Triangle& t, int v, int steps)
  {
    const int place = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    return t[(place + steps) % 3];
  }

  std::array<double, 3> NormalOf(int a, int b, int c) const
  {
    const Point& p = this->Surface.Points[static_cast<std::size_t>(a)];
    const Point& q = this->Surface.Points[static_cast<std::size_t>(b)];
    const Point& r = this->Surface.Points[static_cast<std::size_t>(c)];
    const std::array<double, 3> u = { q[0] - p[0], q[1] - p[1], q[2] - p[2] };
    const std::array<double, 3> w = { r[0] - p[0], r[1] - p[1], r[2] - p[2] };
    return { u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0] };
  }

  static double CosineOf(const std::array<double, 3>& a, const std::array<double, 3>& b)
  {
    const double lengths = std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]);
    return lengths > 0. ? (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / lengths : -1.;
  }

  Flip FindFlip(int v) const
  {
    Flip best{};
    const std::vector<std::size_t>& about = this->About.at(v);
    for (const std::size_t first : about)
    {
      const Triangle& one = this->Surface.Triangles[first];
      const int w = After(one, v, 1);
      const int a = After(one, v, 2);
      const auto second = std::find_if(about.begin(), about.end(),
        [&](std::size_t t) { return After(this->Surface.Triangles[t], v, 2) == w; });
      if (second == about.end())
      {
        continue;
      }
      const int b = After(this->Surface.Triangles[*second], v, 1);
      const auto valence = [this](int p) { return this->Valence[static_cast<std::size_t>(p)]; };
      if (a == b || valence(w) <= LeastValence || valence(a) >= Ring::Capacity ||
        valence(b) >= Ring::Capacity || this->Edges.count(EdgeKey(a, b)) != 0)
      {
        continue;
      }
      const auto before = { this->NormalOf(v, w, a), this->NormalOf(w, v, b) };
      double cosine = 1.;
      for (const auto& after : { this->NormalOf(v, b, a), this->NormalOf(w, a, b) })
      {
        for (const auto& old : before)
        {
          cosine = std::min(cosine, CosineOf(after, old));
        }
      }
      if (cosine > best.Cosine)
      {
        best = { first, *second, w, a, b, cosine, true };
      }
    }
    return best;
  }

  void Do(int v, const Flip& flip)
  {
    this->Surface.Triangles[flip.First] = { v, flip.B, flip.A };
    this->Surface.Triangles[flip.Second] = { flip.W, flip.A, flip.B };
    this->Edges.erase(EdgeKey(v, flip.W));
    this->Edges.insert(EdgeKey(flip.A, flip.B));
    --this->Valence[static_cast<std::size_t>(v)];
    --this->Valence[static_cast<std::size_t>(flip.W)];
    ++this->Valence[static_cast<std::size_t>(flip.A)];
    ++this->Valence[static_cast<std::size_t>(flip.B)];
    this->Change(v, flip.Second, false);
    this->Change(flip.W, flip.First, false);
    this->Change(flip.A, flip.Second, true);
    this->Change(flip.B, flip.First, true);
  }

  /** The triangle now has, or no longer has, this corner. */
  void Change(int corner, std::size_t triangle, bool isThere)
  {
    const auto found = this->About.find(corner);
    if (found == this->About.end())
    {
      return;
    }
    std::vector<std::size_t>& list = found->second;
    if (isThere)
    {
      list.push_back(triangle);
    }
    else
    {
      list.erase(std::find(list.begin(), list.end(), triangle));
    }
  }

  IndexedSurface& Surface;
  std::vector<int> Valence;
  std::vector<int> Full;
  std::unordered_set<std::uint64_t> Edges;
  std::unordered_map<int, std::vector<std::size_t>> About; ///< triangles of those that were full
};
}

bool RelieveRings(IndexedSurface& surface)
{
  return RingReliever(surface).Run();
}
}
