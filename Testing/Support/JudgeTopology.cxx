// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceJudge.h"

#include "JudgeInternals.h"

#include <algorithm>

namespace volumic
{
namespace support
{
namespace
{

using Point = std::array<double, 3>;

class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size)
  {
    this->Parent.reserve(size);
    for (std::size_t i = 0; i < size; ++i)
    {
      this->Parent.push_back(static_cast<int>(i));
    }
  }

  int Root(int i)
  {
    while (this->Parent[i] != i)
    {
      this->Parent[i] = this->Parent[this->Parent[i]];
      i = this->Parent[i];
    }
    return i;
  }

  void Join(int i, int j) { this->Parent[this->Root(i)] = this->Root(j); }

private:
  std::vector<int> Parent;
};

/** One side of a triangle, between its corners `Corner` and the next. */
struct Side
{
  int Low;
  int High;
  int Triangle;
  int Corner;
  bool Forward; ///< the triangle runs from Low to High
};

std::vector<Side> SortedSides(const std::vector<std::array<int, 3>>& triangles)
{
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int from = triangles[t][c];
      const int to = triangles[t][(c + 1) % 3];
      sides.push_back(
        { std::min(from, to), std::max(from, to), static_cast<int>(t), c, from < to });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    {
      return a.Low != b.Low ? a.Low < b.Low
                            : (a.High != b.High ? a.High < b.High : a.Triangle < b.Triangle);
    });
  return sides;
}

/** Corner of the side's triangle at which `point` lies, as a number of its own: 3 triangle +
 * corner. */
int CornerAt(const Side& side, bool low)
{
  const int corner = low == side.Forward ? side.Corner : (side.Corner + 1) % 3;
  return 3 * side.Triangle + corner;
}

struct ComponentParts
{
  std::vector<int> Triangles;
  std::size_t Edges = 0;
  bool Sound = true; ///< closed, manifold, oriented
};

/** Area, volume, vertices of the triangles of one component. `seen` holds, per vertex, the last
    component that counted it. */
void Measure(const TriangleSurface& surface, const std::vector<std::array<int, 3>>& triangles,
  const ComponentParts& part, int number, std::vector<int>& seen, ComponentVerdict& component)
{
  component.Triangles = part.Triangles.size();
  // Relative to a point of the component, so that far-away coordinates cost no digits.
  const Point origin = surface.Points[triangles[part.Triangles[0]][0]];
  for (const int t : part.Triangles)
  {
    Point corner[3];
    for (int c = 0; c < 3; ++c)
    {
      const int v = triangles[t][c];
      corner[c] = Difference(surface.Points[v], origin);
      if (seen[v] != number)
      {
        seen[v] = number;
        ++component.Vertices;
      }
    }
    const Point normal = Cross(Difference(corner[1], corner[0]), Difference(corner[2], corner[0]));
    component.Area += 0.5 * Norm(normal);
    component.Volume += Dot(corner[0], Cross(corner[1], corner[2])) / 6.0;
  }
  component.EulerCharacteristic = static_cast<int>(component.Vertices) -
    static_cast<int>(part.Edges) + static_cast<int>(component.Triangles);
  component.Genus = part.Sound ? (2 - component.EulerCharacteristic) / 2 : -1;
}

} // namespace

//------------------------------------------------------------------------------
TopologyVerdict JudgeTopology(const TriangleSurface& surface)
{
  CheckSurface(surface);
  TopologyVerdict verdict;
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(surface.Triangles.size());
  std::vector<char> used(surface.Points.size(), 0);
  for (const auto& t : surface.Triangles)
  {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    {
      ++verdict.DegenerateTriangles;
      continue;
    }
    triangles.push_back(t);
    used[t[0]] = used[t[1]] = used[t[2]] = 1;
  }
  verdict.UnusedPoints =
    static_cast<std::size_t>(std::count(used.begin(), used.end(), static_cast<char>(0)));

  // Edges; triangles joined to components, corners of triangles joined to fans.
  const std::vector<Side> sides = SortedSides(triangles);
  DisjointSets joined(triangles.size());
  DisjointSets fans(3 * triangles.size());
  std::vector<int> unsound; // a triangle at each flaw
  std::vector<int> edgeOwner;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end)
  {
    while (end < sides.size() && sides[end].Low == sides[begin].Low &&
      sides[end].High == sides[begin].High)
    {
      ++end;
    }
    edgeOwner.push_back(sides[begin].Triangle);
    for (std::size_t s = begin + 1; s < end; ++s)
    {
      joined.Join(sides[begin].Triangle, sides[s].Triangle);
      fans.Join(CornerAt(sides[begin], true), CornerAt(sides[s], true));
      fans.Join(CornerAt(sides[begin], false), CornerAt(sides[s], false));
    }
    const bool open = end - begin == 1;
    const bool crowded = end - begin > 2;
    const bool misoriented = end - begin == 2 && sides[begin].Forward == sides[begin + 1].Forward;
    verdict.OpenEdges += open;
    verdict.NonManifoldEdges += crowded;
    verdict.MisorientedEdges += misoriented;
    if (open || crowded || misoriented)
    {
      unsound.push_back(sides[begin].Triangle);
    }
  }

  // A vertex is manifold when all corners at it belong to one fan.
  std::vector<int> fanOfVertex(surface.Points.size(), -1);
  std::vector<char> severalFans(surface.Points.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int v = triangles[t][c];
      const int fan = fans.Root(static_cast<int>(3 * t) + c);
      if (fanOfVertex[v] >= 0 && fanOfVertex[v] != fan)
      {
        severalFans[v] = 1;
      }
      fanOfVertex[v] = fan;
    }
  }
  verdict.NonManifoldVertices = static_cast<std::size_t>(
    std::count(severalFans.begin(), severalFans.end(), static_cast<char>(1)));

  // Components.
  std::vector<int> numberOfRoot(triangles.size(), -1);
  std::vector<ComponentParts> parts;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    int& number = numberOfRoot[joined.Root(static_cast<int>(t))];
    if (number < 0)
    {
      number = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[number].Triangles.push_back(static_cast<int>(t));
    for (const int v : triangles[t])
    {
      parts[number].Sound = parts[number].Sound && !severalFans[v];
    }
  }
  for (const int t : unsound)
  {
    parts[numberOfRoot[joined.Root(t)]].Sound = false;
  }
  for (const int t : edgeOwner)
  {
    ++parts[numberOfRoot[joined.Root(t)]].Edges;
  }
  verdict.Components.resize(parts.size());
  std::vector<int> seen(surface.Points.size(), -1);
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    Measure(surface, triangles, parts[c], static_cast<int>(c), seen, verdict.Components[c]);
  }

  // Outward means that the volume is positive, or negative for the boundary of a cavity.
  std::vector<int> componentOf(triangles.size());
  std::vector<char> sound(parts.size());
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    sound[c] = parts[c].Sound;
    for (const int t : parts[c].Triangles)
    {
      componentOf[t] = static_cast<int>(c);
    }
  }
  const std::vector<int> depths = NestingDepths(surface.Points, triangles, componentOf, sound);
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    ComponentVerdict& component = verdict.Components[c];
    component.Depth = depths[c];
    component.Outward = parts[c].Sound &&
      (component.Depth % 2 == 0 ? component.Volume > 0.0 : component.Volume < 0.0);
  }
  std::stable_sort(verdict.Components.begin(), verdict.Components.end(),
    [](const ComponentVerdict& a, const ComponentVerdict& b) { return a.Area > b.Area; });

  verdict.Closed = !triangles.empty() && verdict.OpenEdges == 0;
  verdict.Manifold = !triangles.empty() && verdict.NonManifoldEdges == 0 &&
    verdict.NonManifoldVertices == 0 && verdict.DegenerateTriangles == 0;
  verdict.Oriented = !triangles.empty() && verdict.MisorientedEdges == 0;
  verdict.Outward = verdict.Closed && verdict.Manifold && verdict.Oriented;
  verdict.Genus = verdict.Components.empty() ? -1 : 0;
  for (const ComponentVerdict& component : verdict.Components)
  {
    verdict.EulerCharacteristic += component.EulerCharacteristic;
    verdict.Area += component.Area;
    verdict.Volume += component.Volume;
    verdict.Outward = verdict.Outward && component.Outward;
    verdict.Genus = component.Genus < 0 || verdict.Genus < 0 ? -1 : verdict.Genus + component.Genus;
  }
  return verdict;
}

} // namespace support
} // namespace volumic
