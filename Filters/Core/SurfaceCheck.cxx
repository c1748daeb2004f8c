// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCheck.h"

#include "Join.h"
#include "SurfaceMesh.h"
#include "TriangleTests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace volumic
{
namespace
{
[[noreturn]] void Refuse(const std::string& what)
{
  throw std::invalid_argument("The initial surface " + what);
}

void CheckIndices(const IndexedSurface& surface)
{
  if (surface.Triangles.empty())
  {
    Refuse("is empty: it has no triangles. Give a closed triangle mesh.");
  }
  const int n = static_cast<int>(surface.Points.size());
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const Triangle& t = surface.Triangles[i];
    for (int corner : t)
    {
      if (corner < 0 || corner >= n)
      {
        Refuse("has triangle " + std::to_string(i) + " with point " + std::to_string(corner) +
          ", but there are " + std::to_string(n) + " points.");
      }
      for (double x : surface.Points[corner])
      {
        if (!std::isfinite(x))
        {
          Refuse("has a coordinate that is not finite at point " + std::to_string(corner) + ".");
        }
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    {
      Refuse("has a degenerate triangle (number " + std::to_string(i) +
        " uses a point twice). Clean it first, for example with vtkCleanPolyData.");
    }
  }
}

void CheckEdges(const IndexedSurface& surface)
{
  std::unordered_map<long long, std::pair<int, int>> edges; // uses in either direction
  edges.reserve(surface.Triangles.size() * 2);
  const long long n = static_cast<long long>(surface.Points.size());
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      auto& uses = edges[std::min(a, b) * n + std::max(a, b)];
      ++(a < b ? uses.first : uses.second);
    }
  }
  int open = 0;
  int crowded = 0;
  int twisted = 0;
  for (const auto& edge : edges)
  {
    const int uses = edge.second.first + edge.second.second;
    open += uses == 1;
    crowded += uses > 2;
    twisted += uses == 2 && edge.second.first != 1;
  }
  if (open > 0)
  {
    Refuse("is open: " + std::to_string(open) +
      " edges have one triangle only. Close its holes, for example with vtkFillHolesFilter.");
  }
  if (crowded > 0)
  {
    Refuse("is not manifold: " + std::to_string(crowded) +
      " edges have more than two triangles. Clean it first.");
  }
  if (twisted > 0)
  {
    Refuse("is not oriented: " + std::to_string(twisted) +
      " edges have two triangles that disagree on their orientation. Orient it, for example with "
      "vtkPolyDataNormals and ConsistencyOn.");
  }
}

void CheckVertices(const IndexedSurface& surface)
{
  // Edges being in order, a vertex is a manifold one if its triangles form a single fan.
  std::vector<std::vector<std::pair<int, int>>> opposite(surface.Points.size());
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      opposite[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    }
  }
  int pinched = 0;
  for (const auto& edges : opposite)
  {
    if (edges.empty())
    {
      continue;
    }
    std::unordered_map<int, int> next(edges.begin(), edges.end());
    std::size_t steps = 0;
    int at = edges.front().first;
    do
    {
      at = next[at];
      ++steps;
    } while (at != edges.front().first && steps <= edges.size());
    pinched += steps != edges.size();
  }
  if (pinched > 0)
  {
    Refuse("is not manifold: at " + std::to_string(pinched) +
      " points several fans of triangles touch. Give each fan a point of its own.");
  }
}

void CheckOrientation(const IndexedSurface& surface)
{
  // Cavities are legal, so it is the component with the largest volume that must face outward.
  const SurfaceFeatures features = ComputeFeatures(surface);
  double largest = 0.;
  for (const ComponentFeatures& c : features.Components)
  {
    largest = std::abs(c.Volume) > std::abs(largest) ? c.Volume : largest;
  }
  if (largest < 0.)
  {
    Refuse(Join("is inside out: it encloses a volume of ", largest) +
      ". Reverse it, for example with vtkReverseSense.");
  }
  if (largest == 0.)
  {
    Refuse("encloses no volume.");
  }
}
}

void CheckInitialSurface(const IndexedSurface& surface)
{
  CheckIndices(surface);
  CheckEdges(surface);
  CheckVertices(surface);
  CheckOrientation(surface);
  constexpr int limit = 1000;
  const int pairs = CountSelfIntersections(surface, limit);
  if (pairs > 0)
  {
    Refuse("intersects itself: " + std::string(pairs >= limit ? "at least " : "") +
      std::to_string(pairs) + " pairs of triangles meet. Repair it before it is given.");
  }
}

void CheckOverlapsImage(const IndexedSurface& surface, const LevelImage& image)
{
  for (int k = 0; k < 3; ++k)
  {
    double low = std::numeric_limits<double>::max();
    double high = -low;
    for (const Point& p : surface.Points)
    {
      low = std::min(low, p[k]);
      high = std::max(high, p[k]);
    }
    if (high < 0. || low > image.Size[k] * image.Step[k])
    {
      Refuse(Join("lies wholly outside the image: along axis ", k, " it runs from ", low, " to ",
        high, " voxels, the image from 0 to ", image.Size[k] * image.Step[k],
        ". Check that both use the same space."));
    }
  }
}

int CountSelfIntersections(const IndexedSurface& surface, int limit)
{
  // Boxes of triangles in a sparse grid with cells of the size of a mean edge.
  const std::size_t count = surface.Triangles.size();
  double sum = 0.;
  double extent = 0.;
  std::vector<NamedTriangle> triangles(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Triangle& t = surface.Triangles[i];
    for (int k = 0; k < 3; ++k)
    {
      const Point& p = surface.Points[t[k]];
      triangles[i].Name[k] = t[k];
      triangles[i].Corner[k] = VectorD(static_cast<float>(p[0]), static_cast<float>(p[1]),
        static_cast<float>(p[2]));
      extent = std::max({ extent, std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
    }
    sum += Length(triangles[i].Corner[1] - triangles[i].Corner[0]);
  }
  const double cell = std::max(2. * sum / std::max<std::size_t>(count, 1), extent * 1e-5);
  if (!(cell > 0.))
  {
    return 0;
  }
  struct Entry
  {
    long long Key;
    int Triangle;
  };
  std::vector<Entry> entries;
  const auto place = [cell](double x) { return static_cast<long long>(std::floor(x / cell)); };
  for (std::size_t i = 0; i < count; ++i)
  {
    long long low[3];
    long long high[3];
    const VectorD* p = triangles[i].Corner;
    low[0] = place(std::min({ p[0].X, p[1].X, p[2].X }));
    high[0] = place(std::max({ p[0].X, p[1].X, p[2].X }));
    low[1] = place(std::min({ p[0].Y, p[1].Y, p[2].Y }));
    high[1] = place(std::max({ p[0].Y, p[1].Y, p[2].Y }));
    low[2] = place(std::min({ p[0].Z, p[1].Z, p[2].Z }));
    high[2] = place(std::max({ p[0].Z, p[1].Z, p[2].Z }));
    for (long long z = low[2]; z <= high[2]; ++z)
    {
      for (long long y = low[1]; y <= high[1]; ++y)
      {
        for (long long x = low[0]; x <= high[0]; ++x)
        {
          const long long bias = 1 << 20;
          entries.push_back({ ((z + bias) << 42) | ((y + bias) << 21) | (x + bias),
            static_cast<int>(i) });
        }
      }
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b)
    { return a.Key != b.Key ? a.Key < b.Key : a.Triangle < b.Triangle; });
  std::vector<std::pair<int, int>> hits;
  for (std::size_t begin = 0; begin < entries.size();)
  {
    std::size_t end = begin;
    while (end < entries.size() && entries[end].Key == entries[begin].Key)
    {
      ++end;
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      for (std::size_t j = i + 1; j < end; ++j)
      {
        if (TrianglesMeet(
              triangles[entries[i].Triangle], triangles[entries[j].Triangle], 1e-9 * cell))
        {
          hits.emplace_back(entries[i].Triangle, entries[j].Triangle);
        }
      }
    }
    begin = end;
    if (limit > 0 && static_cast<int>(hits.size()) > 27 * limit)
    {
      break;
    }
  }
  std::sort(hits.begin(), hits.end());
  hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
  const int found = static_cast<int>(hits.size());
  return limit > 0 ? std::min(found, limit) : found;
}

std::string DescribeBrokenInvariant(const SurfaceMesh& mesh)
{
  int alive = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    const std::string name = "vertex " + std::to_string(v);
    if (ring.Count == 0)
    {
      continue;
    }
    ++alive;
    if (ring.Count < 3 || ring.Count > Ring::Capacity)
    {
      return name + " has " + std::to_string(ring.Count) + " neighbours";
    }
    const Vector& p = mesh.Position[v];
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(p.Z))
    {
      return name + " has a position that is not finite";
    }
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      if (w < 0 || w >= mesh.Size() || w == v || !mesh.IsAlive(w))
      {
        return name + " has the neighbour " + std::to_string(w) + ", which is none";
      }
      for (int j = i + 1; j < ring.Count; ++j)
      {
        if (ring.Item[j] == w)
        {
          return name + " has the neighbour " + std::to_string(w) + " twice";
        }
      }
      // The face (v, w, next) must be seen from w as (w, next, v).
      const Ring& other = mesh.Rings[w];
      const int at = other.Find(ring.Next(i));
      if (at < 0 || other.Next(at) != v)
      {
        return name + " and " + std::to_string(w) + " disagree about their common face";
      }
    }
  }
  if (alive != mesh.NumberOfVertices())
  {
    return "the free list does not fit: " + std::to_string(alive) + " alive, " +
      std::to_string(mesh.NumberOfVertices()) + " expected";
  }
  return {};
}
}
