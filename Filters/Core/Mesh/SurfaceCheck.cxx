// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceCheck.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Mesh/ObliqueRotation.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
template <typename... Parts>
[[noreturn]] void ThrowInvalidSurface(const Parts&... parts)
{
  ThrowInvalidArgument("The initial surface ", parts...);
}

void CheckIndices(const IndexedSurface& surface)
{
  if (surface.Triangles.empty())
  {
    ThrowInvalidSurface("is empty. Provide a closed triangle mesh.");
  }
  const int n = static_cast<int>(surface.Points.size());
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const Triangle& t = surface.Triangles[i];
    for (int corner : t)
    {
      if (corner < 0 || corner >= n)
      {
        ThrowInvalidSurface("has an invalid index: triangle ", i, " has point ", corner,
          ", but there are ", n, " points. Correct the triangles.");
      }
      for (double x : surface.Points[corner])
      {
        if (!std::isfinite(x))
        {
          ThrowInvalidSurface(
            "has a coordinate that is not finite at point ", corner, ". Correct the point.");
        }
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    {
      ThrowInvalidSurface("has a degenerate triangle: triangle ", i,
        " uses a point twice. Remove it, for example with vtkCleanPolyData.");
    }
  }
}

void CheckEdges(const IndexedSurface& surface)
{
  std::unordered_map<long long, std::pair<int, int>> edges; // Uses in either direction.
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
  int nonManifold = 0;
  int misoriented = 0;
  for (const auto& edge : edges)
  {
    const int uses = edge.second.first + edge.second.second;
    open += uses == 1;
    nonManifold += uses > 2;
    misoriented += uses == 2 && edge.second.first != 1;
  }
  if (open > 0)
  {
    ThrowInvalidSurface("is not closed: ", open,
      " edges have only one triangle. Fill its holes, for example with vtkFillHolesFilter, or "
      "merge coincident points with vtkCleanPolyData.");
  }
  if (nonManifold > 0)
  {
    ThrowInvalidSurface("is not manifold: ", nonManifold,
      " edges have more than two triangles. Remove surplus triangles.");
  }
  if (misoriented > 0)
  {
    ThrowInvalidSurface("is not consistently oriented: ", misoriented,
      " edges have two triangles of opposite orientation. Orient it, for example with "
      "vtkPolyDataNormals and ConsistencyOn.");
  }
}

void CheckVertices(const IndexedSurface& surface)
{
  // All edges are valid, so a vertex is manifold if its triangles form a single fan.
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
    ThrowInvalidSurface("is not manifold: ", pinched,
      " points join several triangle fans. Duplicate these points, one for each fan.");
  }
}

void CheckOrientation(const IndexedSurface& surface)
{
  // Cavities are legal. Therefore only the component with the largest volume must face outward.
  const SurfaceFeatures features = ComputeFeatures(surface);
  double largest = 0.;
  for (const ComponentFeatures& c : features.Components)
  {
    largest = std::abs(c.Volume) > std::abs(largest) ? c.Volume : largest;
  }
  if (largest < 0.)
  {
    ThrowInvalidSurface(
      "is inside out: its volume is ", largest, ". Reverse it, for example with vtkReverseSense.");
  }
  if (largest == 0.)
  {
    ThrowInvalidSurface("encloses no volume. Provide a surface with a positive volume.");
  }
}

/** Return an interior point of a triangle that is not aligned with simple fractions. */
Point PointIn(const IndexedSurface& surface, const Triangle& t)
{
  constexpr double weights[3] = { 0.41421, 0.35425, 0.23154 }; // Their sum is 1.
  Point point;
  for (int k = 0; k < 3; ++k)
  {
    point[k] = weights[0] * surface.Points[t[0]][k] + weights[1] * surface.Points[t[1]][k] +
      weights[2] * surface.Points[t[2]][k];
  }
  return point;
}

/**
 * Throw unless every component faces outward, or inward if it is a cavity of one that faces
 * outward. Only then is the surface the boundary of a volume.
 */
void CheckNesting(const IndexedSurface& surface)
{
  const SurfaceFeatures features = ComputeFeatures(surface);
  const std::size_t count = features.Components.size();
  if (count == 1)
  {
    return;
  }
  std::vector<const Triangle*> first(count, nullptr);
  for (std::size_t i = surface.Triangles.size(); i-- > 0;)
  {
    first[features.ComponentOfTriangle[i]] = &surface.Triangles[i];
  }
  IndexedSurface rotated = surface;
  const ObliqueRotation rotation(0);
  for (Point& p : rotated.Points)
  {
    p = rotation.Apply(p);
  }
  const TriangleTree tree(rotated);
  int misoriented = 0;
  for (std::size_t c = 0; c < count; ++c)
  {
    const int winding = tree.WindingNumber(PointIn(rotated, *first[c]),
      [&](int t) { return features.ComponentOfTriangle[t] != static_cast<int>(c); });
    const bool isCavity = features.Components[c].Volume < 0.;
    misoriented += winding != (isCavity ? 1 : 0);
  }
  if (misoriented > 0)
  {
    ThrowInvalidSurface("is not the boundary of a volume: ", misoriented, " of its ", count,
      " components have the wrong orientation. Orient cavities inward, and components inside a "
      "cavity or outside all others outward.");
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
    ThrowInvalidSurface("intersects itself: ", pairs >= limit ? "at least " : "", pairs,
      " pairs of triangles intersect. Repair it first.");
  }
  CheckNesting(surface);
}
}
