// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Remesher.h"

#include "Core/Mesh/EdgeCollapse.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace volumic
{
namespace
{
constexpr int DeepestSplit = 4; ///< recursion of SplitEdge()
/** Least distances in delta of opposite vertices from the midpoint and the ends, least length. */
constexpr float UniformNeedle[] = { 0.02f, 0.f, 0.f };
constexpr float GradedNeedle[] = { 0.05f, 0.03f, 0.5f };
/** Number of rollbacks after which a vertex is stuck. */
constexpr int StuckRollbacks = 6;
/** Longest edge of a stuck vertex that is collapsed, in shortest legal edges. */
constexpr float StuckCollapse = 1.3f;
}

void Remesher::Find(const std::vector<int>& vertices, RemeshFlag flag)
{
  const SurfaceState& s = this->State;
  this->Items.clear();
  std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(this->Items),
    [&s, flag](int v) { return s.Mesh.IsAlive(v) && (s.RemeshFlags[v] & flag) != 0; });
}

bool Remesher::MakesNeedles(int u, int v, const EdgeFlip& across) const
{
  // If the longest edge of a triangle cannot be split, the two others would be split in turn. Each
  // midpoint would be a quarter as far from the last one, until all are collinear. Intersection
  // tests fail for such needles. Refuse few splits, because tests miss faces of long edges.
  const SurfaceState& s = this->State;
  const float* least = s.Sizing.IsGraded() ? GradedNeedle : UniformNeedle;
  const float delta = s.Sizing.ShortestEdge(u, v);
  const Vector ends[] = { s.Mesh.Position[u], s.Mesh.Position[v] };
  const auto isWithin = [&](const Vector& p, const Vector& q, float distance)
  { return SquaredDistance(p, q) < distance * delta * (distance * delta); };
  const auto isNear = [&](const Vector& p)
  {
    return isWithin(p, (ends[0] + ends[1]) * 0.5f, least[0]) || isWithin(p, ends[0], least[1]) ||
      isWithin(p, ends[1], least[1]);
  };
  return isWithin(ends[0], ends[1], least[2]) || isNear(s.Mesh.Position[across.A]) ||
    isNear(s.Mesh.Position[across.B]);
}

bool Remesher::SplitEdge(int u, int v, std::vector<int>& added, int depth)
{
  SurfaceState& s = this->State;
  if (!s.Mesh.AreNeighbours(u, v))
  {
    return true; // Split by the recursion.
  }
  const EdgeFlip across = EdgeFlip::Of(s.Mesh, u, v);
  if (this->MakesNeedles(u, v, across))
  {
    return false;
  }
  Edit split = this->Editor.Split(u, v);
  if (!split && depth > 0)
  {
    // The ring of an opposite vertex is full. After a split of an edge from it to one of the ends,
    // the midpoint of that edge is the opposite vertex.
    for (int full : { across.A, across.B })
    {
      if (s.Mesh.Rings[full].Count == Ring::Capacity && !this->SplitEdge(full, u, added, depth - 1))
      {
        this->SplitEdge(full, v, added, depth - 1);
      }
    }
    if (!s.Mesh.AreNeighbours(u, v))
    {
      return true;
    }
    split = this->Editor.Split(u, v);
  }
  if (split)
  {
    s.RemeshFlags[split.Vertex] = HasLongEdge; // Split() tests it later.
    added.push_back(split.Vertex);
  }
  return split.IsDone;
}

void Remesher::SplitAt(int v, std::vector<int>& added)
{
  SurfaceState& s = this->State;
  if (!s.Mesh.IsAlive(v) || !(s.RemeshFlags[v] & HasLongEdge))
  {
    return;
  }
  bool blocked = false;
  for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
  {
    const int w = s.Mesh.Rings[v].Item[i];
    const float longest = s.Sizing.LongestEdge(v, w);
    if (SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) > longest * longest)
    {
      blocked = !this->SplitEdge(v, w, added, DeepestSplit) || blocked;
    }
  }
  if (!blocked)
  {
    s.RemeshFlags[v] &= static_cast<std::uint8_t>(~(HasLongEdge | HasHugeEdge));
  }
}

void Remesher::Split(std::vector<int>& vertices)
{
  this->Find(vertices, HasLongEdge);
  // The list grows in the loop: new vertices may have long edges.
  const std::size_t given = this->Items.size();
  for (std::size_t i = 0; i < this->Items.size(); ++i)
  {
    this->SplitAt(this->Items[i], this->Items);
  }
  vertices.insert(
    vertices.end(), this->Items.begin() + static_cast<std::ptrdiff_t>(given), this->Items.end());
}

void Remesher::CollapseAt(int v)
{
  const SurfaceState& s = this->State;
  for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
  {
    const int w = s.Mesh.Rings[v].Item[i];
    const float shortest = s.Sizing.ShortestEdge(v, w);
    if (SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) >= shortest * shortest)
    {
      continue;
    }
    const int a = s.Mesh.Rings[v].Next(i);
    const int b = s.Mesh.Rings[v].Previous(i);
    const bool removedA = s.Mesh.Rings[a].Count == 3 && this->Editor.Remove(a).IsDone;
    const bool removedB = s.Mesh.Rings[b].Count == 3 && this->Editor.Remove(b).IsDone;
    if (removedA || removedB)
    {
      i = -1; // The ring has changed.
      continue;
    }
    const EdgeCollapse collapse{ v, w };
    if (collapse.IsLegal(s.Mesh))
    {
      if (this->Editor.Collapse(v, w, EditTolerance::Smooth))
      {
        i = -1;
      }
      continue;
    }
    const int c = collapse.ThirdCommonNeighbour(s.Mesh);
    if (c >= 0 && this->TopologyChanges && this->Editor.Cut(v, w, c))
    {
      i = -1;
    }
  }
}

void Remesher::Collapse(const std::vector<int>& vertices)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  this->Find(vertices, HasShortEdge);
  for (const int v : this->Items)
  {
    if (mesh.IsAlive(v) && !(mesh.Rings[v].Count == 3 && this->Editor.Remove(v)))
    {
      this->CollapseAt(v);
    }
  }
}

void Remesher::FlipAt(int v)
{
  const SurfaceState& s = this->State;
  for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
  {
    const Ring& ring = s.Mesh.Rings[v];
    const int w = ring.Item[i];
    const Vector& p = s.Mesh.Position[v];
    const Vector& q = s.Mesh.Position[w];
    const Vector& a = s.Mesh.Position[ring.Next(i)];
    const Vector& b = s.Mesh.Position[ring.Previous(i)];
    const float sineA = Length(Cross(p - a, q - a));
    const float sineB = Length(Cross(p - b, q - b));
    if (Dot(p - a, q - a) * sineB + Dot(p - b, q - b) * sineA < LeastCotangentSum * sineA * sineB &&
      ring.Count > 3 && this->Editor.Flip(v, w, EditTolerance::Smooth))
    {
      --i;
    }
  }
}

void Remesher::Flip(const std::vector<int>& vertices)
{
  this->Find(vertices, IsNotDelaunay);
  for (const int v : this->Items)
  {
    if (this->State.Mesh.IsAlive(v))
    {
      this->FlipAt(v);
    }
  }
}

void Remesher::UnstickAt(int v)
{
  SurfaceState& s = this->State;
  s.RollbackCount[v] = 0;
  if (s.Mesh.Rings[v].Count == 3 && this->Editor.Remove(v))
  {
    return;
  }
  const Ring& ring = s.Mesh.Rings[v];
  int nearest = ring.Item[0];
  Vector sum;
  for (int i = 0; i < ring.Count; ++i)
  {
    const Vector& q = s.Mesh.Position[ring.Item[i]];
    sum += q;
    if (SquaredDistance(q, s.Mesh.Position[v]) <
      SquaredDistance(s.Mesh.Position[nearest], s.Mesh.Position[v]))
    {
      nearest = ring.Item[i];
    }
  }
  const Vector centre = sum * (1.f / static_cast<float>(ring.Count));
  const Vector p = s.Mesh.Position[v];
  const float close = StuckCollapse * s.Sizing.ShortestEdge(v, nearest);
  if (SquaredDistance(p, s.Mesh.Position[nearest]) < close * close &&
    this->Editor.Collapse(v, nearest, EditTolerance::Loose))
  {
    return;
  }
  for (float fraction : { 0.5f, 0.25f, 0.1f })
  {
    if (this->Editor.Move(v, p + (centre - p) * fraction, EditTolerance::Loose))
    {
      s.Velocity[v] = Vector();
      break;
    }
  }
}

void Remesher::Unstick(const std::vector<int>& vertices)
{
  const SurfaceState& s = this->State;
  for (const int v : vertices)
  {
    if (s.Mesh.IsAlive(v) && s.RollbackCount[v] >= StuckRollbacks)
    {
      this->UnstickAt(v);
    }
  }
}
}
