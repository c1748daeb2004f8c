// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceJudge.h"

#include "JudgeInternals.h"

#include <algorithm>
#include <utility>

namespace volumic::support
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

/**
 * Corner of the side's triangle at which `point` lies, as a number of its own: 3 triangle +
 * corner.
 */
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

/** A judgement of topology at work, step by step; each step needs those before it. */
class TopologyJudge
{
public:
  explicit TopologyJudge(const TriangleSurface& surface) : Surface(surface) {}

  TopologyVerdict Judge()
  {
    this->LeaveOutDegenerateTriangles();
    this->JudgeEdges();
    this->JudgeVertices();
    this->FindComponents();
    this->MeasureComponents();
    this->JudgeOrientation();
    this->Sum();
    return std::move(this->Verdict);
  }

private:
  void LeaveOutDegenerateTriangles();
  void JudgeEdges();
  void JudgeVertices();
  void FindComponents();
  void MeasureComponents();
  void Measure(std::size_t number, std::vector<std::size_t>& counted);
  void JudgeOrientation();
  void Sum();

  ComponentParts& PartOf(int triangle)
  {
    return this->Parts[this->NumberOfRoot[this->Joined.Root(triangle)]];
  }

  const TriangleSurface& Surface;
  TopologyVerdict Verdict;
  std::vector<std::array<int, 3>> Triangles;
  DisjointSets Joined{ 0 };         ///< triangles that share an edge
  DisjointSets Fans{ 0 };           ///< corners of triangles that share an edge at their vertex
  std::vector<int> Unsound;         ///< a triangle at each edge that is not as it should be
  std::vector<int> EdgeOwner;       ///< a triangle at each edge
  std::vector<char> HasSeveralFans; ///< by vertex
  std::vector<int> NumberOfRoot;    ///< of the component of a root of Joined
  std::vector<ComponentParts> Parts;
};

void TopologyJudge::LeaveOutDegenerateTriangles()
{
  this->Triangles.reserve(this->Surface.Triangles.size());
  std::vector<char> used(this->Surface.Points.size(), 0);
  for (const auto& t : this->Surface.Triangles)
  {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    {
      ++this->Verdict.DegenerateTriangles;
      continue;
    }
    this->Triangles.push_back(t);
    used[t[0]] = used[t[1]] = used[t[2]] = 1;
  }
  this->Verdict.UnusedPoints =
    static_cast<std::size_t>(std::count(used.begin(), used.end(), static_cast<char>(0)));
}

void TopologyJudge::JudgeEdges()
{
  const std::vector<Side> sides = SortedSides(this->Triangles);
  this->Joined = DisjointSets(this->Triangles.size());
  this->Fans = DisjointSets(3 * this->Triangles.size());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end)
  {
    while (end < sides.size() && sides[end].Low == sides[begin].Low &&
      sides[end].High == sides[begin].High)
    {
      ++end;
    }
    this->EdgeOwner.push_back(sides[begin].Triangle);
    for (std::size_t s = begin + 1; s < end; ++s)
    {
      this->Joined.Join(sides[begin].Triangle, sides[s].Triangle);
      this->Fans.Join(CornerAt(sides[begin], true), CornerAt(sides[s], true));
      this->Fans.Join(CornerAt(sides[begin], false), CornerAt(sides[s], false));
    }
    const bool open = end - begin == 1;
    const bool crowded = end - begin > 2;
    const bool misoriented = end - begin == 2 && sides[begin].Forward == sides[begin + 1].Forward;
    this->Verdict.OpenEdges += open;
    this->Verdict.NonManifoldEdges += crowded;
    this->Verdict.MisorientedEdges += misoriented;
    if (open || crowded || misoriented)
    {
      this->Unsound.push_back(sides[begin].Triangle);
    }
  }
}

/** A vertex is manifold when all corners at it belong to one fan. */
void TopologyJudge::JudgeVertices()
{
  std::vector<int> fanOfVertex(this->Surface.Points.size(), -1);
  this->HasSeveralFans.assign(this->Surface.Points.size(), 0);
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int v = this->Triangles[t][c];
      const int fan = this->Fans.Root(static_cast<int>(3 * t) + c);
      if (fanOfVertex[v] >= 0 && fanOfVertex[v] != fan)
      {
        this->HasSeveralFans[v] = 1;
      }
      fanOfVertex[v] = fan;
    }
  }
  this->Verdict.NonManifoldVertices = static_cast<std::size_t>(
    std::count(this->HasSeveralFans.begin(), this->HasSeveralFans.end(), static_cast<char>(1)));
}

void TopologyJudge::FindComponents()
{
  this->NumberOfRoot.assign(this->Triangles.size(), -1);
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    int& number = this->NumberOfRoot[this->Joined.Root(static_cast<int>(t))];
    if (number < 0)
    {
      number = static_cast<int>(this->Parts.size());
      this->Parts.emplace_back();
    }
    ComponentParts& part = this->Parts[number];
    part.Triangles.push_back(static_cast<int>(t));
    for (const int v : this->Triangles[t])
    {
      part.Sound = part.Sound && !this->HasSeveralFans[v];
    }
  }
  for (const int t : this->Unsound)
  {
    this->PartOf(t).Sound = false;
  }
  for (const int t : this->EdgeOwner)
  {
    ++this->PartOf(t).Edges;
  }
}

void TopologyJudge::MeasureComponents()
{
  this->Verdict.Components.resize(this->Parts.size());
  std::vector<std::size_t> counted(this->Surface.Points.size(), this->Parts.size());
  for (std::size_t c = 0; c < this->Parts.size(); ++c)
  {
    this->Measure(c, counted);
  }
}

/** Area, volume and vertices of a component. `counted`: the last component to count each vertex. */
void TopologyJudge::Measure(std::size_t number, std::vector<std::size_t>& counted)
{
  const ComponentParts& part = this->Parts[number];
  ComponentVerdict& component = this->Verdict.Components[number];
  component.Triangles = part.Triangles.size();
  // Relative to a point of the component, so that far-away coordinates cost no digits.
  const Point origin = this->Surface.Points[this->Triangles[part.Triangles[0]][0]];
  for (const int t : part.Triangles)
  {
    Point corner[3];
    for (int c = 0; c < 3; ++c)
    {
      const int v = this->Triangles[t][c];
      corner[c] = Difference(this->Surface.Points[v], origin);
      if (counted[v] != number)
      {
        counted[v] = number;
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

/** Outward means that the volume is positive, or negative for the boundary of a cavity. */
void TopologyJudge::JudgeOrientation()
{
  std::vector<int> componentOf(this->Triangles.size());
  std::vector<char> sound(this->Parts.size());
  for (std::size_t c = 0; c < this->Parts.size(); ++c)
  {
    sound[c] = this->Parts[c].Sound;
    for (const int t : this->Parts[c].Triangles)
    {
      componentOf[t] = static_cast<int>(c);
    }
  }
  const std::vector<int> depths =
    NestingDepths(this->Surface.Points, this->Triangles, componentOf, sound);
  for (std::size_t c = 0; c < this->Parts.size(); ++c)
  {
    ComponentVerdict& component = this->Verdict.Components[c];
    component.Depth = depths[c];
    component.Outward = this->Parts[c].Sound &&
      (component.Depth % 2 == 0 ? component.Volume > 0.0 : component.Volume < 0.0);
  }
}

/** What the components come to, which get their final order. */
void TopologyJudge::Sum()
{
  TopologyVerdict& verdict = this->Verdict;
  std::stable_sort(verdict.Components.begin(), verdict.Components.end(),
    [](const ComponentVerdict& a, const ComponentVerdict& b) { return a.Area > b.Area; });
  const bool isEmpty = this->Triangles.empty();
  verdict.Closed = !isEmpty && verdict.OpenEdges == 0;
  verdict.Manifold = !isEmpty && verdict.NonManifoldEdges == 0 &&
    verdict.NonManifoldVertices == 0 && verdict.DegenerateTriangles == 0;
  verdict.Oriented = !isEmpty && verdict.MisorientedEdges == 0;
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
}

} // namespace

//------------------------------------------------------------------------------
TopologyVerdict JudgeTopology(const TriangleSurface& surface)
{
  CheckSurface(surface);
  return TopologyJudge(surface).Judge();
}

} // namespace volumic::support
