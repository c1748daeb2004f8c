// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceCheck.h"

#include "Core/Common/Join.h"
#include "Core/Mesh/ObliqueRotation.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "Core/Mesh/TriangleTree.h"

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
      " edges have one triangle only. Close its holes, for example with vtkFillHolesFilter, or, "
      "where triangles have points of their own at the same places, merge these with "
      "vtkCleanPolyData.");
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

/**
 * Every component must face outward, or inward if it is a cavity of one that does: only then is
 * the whole the boundary of a volume.
 */
void CheckNesting(const IndexedSurface& surface)
{
  const SurfaceFeatures features = ComputeFeatures(surface);
  std::vector<int> first(features.Components.size(), -1);
  const int count = static_cast<int>(surface.Triangles.size());
  for (int i = count - 1; i >= 0; --i)
  {
    first[features.ComponentOfTriangle[i]] = i;
  }
  if (first.size() == 1)
  {
    return;
  }
  IndexedSurface turned = surface;
  const ObliqueRotation rotation(0);
  for (Point& p : turned.Points)
  {
    p = rotation.Apply(p);
  }
  const TriangleTree tree(turned);
  int wrong = 0;
  for (std::size_t c = 0; c < first.size(); ++c)
  {
    // How often do the others go round a place in a triangle of this one?
    const Triangle& own = turned.Triangles[first[c]];
    Point place;
    for (int k = 0; k < 3; ++k)
    {
      place[k] = 0.41421 * turned.Points[own[0]][k] + 0.35425 * turned.Points[own[1]][k] +
        0.23154 * turned.Points[own[2]][k];
    }
    int around = 0;
    tree.Traverse(
      [&place](const TriangleTree::Node& node)
      {
        return node.Low[0] <= place[0] && node.Low[1] <= place[1] && node.High[1] >= place[1] &&
          node.Low[2] <= place[2] && node.High[2] >= place[2];
      },
      [&](int i)
      {
        if (features.ComponentOfTriangle[i] != static_cast<int>(c))
        {
          const RowCrossing crossing =
            RowCrossing::Of(turned, turned.Triangles[i], place[1], place[2]);
          around += crossing.X < place[0] ? crossing.Turn : 0;
        }
        return true;
      });
    const bool isCavity = features.Components[c].Volume < 0.;
    wrong += around != (isCavity ? 1 : 0);
  }
  if (wrong > 0)
  {
    Refuse("is not the boundary of a volume: " + std::to_string(wrong) + " of its " +
      std::to_string(first.size()) +
      " components face the wrong way. Those inside another one are cavities and must face inward, "
      "those inside a cavity or outside of all must face outward.");
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
  CheckNesting(surface);
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
