// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Remesher.h"

#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Splits that may have to come before one, see SplitEdge. */
constexpr int DeepestSplit = 4;
/** Cosine between the normals of two stars that just don't face each other: 107 degrees. */
constexpr float FacingCosine = -0.3f;
/** Least cosine between a star's normal and the line to the other one: it lies ahead or behind. */
constexpr float AheadCosine = 0.3f;
/** Roll backs after which a vertex counts as stuck. */
constexpr int StuckRollbacks = 6;
/** Longest edge of a stuck vertex that is collapsed, of the shortest legal edge. */
constexpr float StuckCollapse = 1.3f;
}

bool Remesher::SplitEdge(int u, int v, std::vector<int>& added, int depth)
{
  SurfaceState& s = this->State;
  if (!s.Mesh.AreNeighbours(u, v))
  {
    return true; // Split on the way to another one.
  }
  Edit split = this->Editor.Split(u, v);
  if (!split && depth > 0)
  {
    // A vertex opposite to the edge has no room for another neighbour. Once an edge from it to one
    // of the ends is split, that one's middle is what lies opposite.
    const EdgeFlip across = EdgeFlip::Of(s.Mesh, u, v);
    for (int full : { across.A, across.B })
    {
      if (s.Mesh.Rings[full].Count == Ring::Capacity &&
        !this->SplitEdge(full, u, added, depth - 1))
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
    s.RemeshFlags[split.Vertex] = HasLongEdge; // Checked when the walk reaches it.
    added.push_back(split.Vertex);
  }
  return split.IsDone;
}

void Remesher::Split(std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  // The list grows while it is walked: new vertices may have long edges of their own.
  for (std::size_t n = 0; n < vertices.size(); ++n)
  {
    const int v = vertices[n];
    if (!s.Mesh.IsAlive(v) || !(s.RemeshFlags[v] & HasLongEdge))
    {
      continue;
    }
    bool blocked = false;
    for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
    {
      const int w = s.Mesh.Rings[v].Item[i];
      const float longest = s.Sizing.LongestEdge(v, w);
      if (SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) > longest * longest)
      {
        blocked = !this->SplitEdge(v, w, vertices, DeepestSplit) || blocked;
      }
    }
    if (!blocked)
    {
      s.RemeshFlags[v] &= static_cast<std::uint8_t>(~HasLongEdge);
    }
  }
}

bool Remesher::IsMergeWanted(int u, int v) const
{
  const SurfaceState& s = this->State;
  const Vector across = s.Mesh.Position[v] - s.Mesh.Position[u];
  const float distance = Length(across);
  const Vector n = s.Normal[u].Axis();
  const Vector m = s.Normal[v].Axis();
  if (distance <= 0 || Dot(n, m) > FacingCosine)
  {
    return false;
  }
  // In front of each other: the gap is outside and would become part of the object.
  const float ahead = Dot(n, across) / distance;
  const float back = -Dot(m, across) / distance;
  const bool front = ahead > AheadCosine && back > AheadCosine;
  const bool behind = ahead < -AheadCosine && back < -AheadCosine;
  if (!front && !behind)
  {
    return false;
  }
  if (!this->TheField)
  {
    return Dot(s.Velocity[v] - s.Velocity[u], across) < 0;
  }
  const float sign = front ? 1.f : -1.f;
  const float middle =
    this->TheField->ValueAt((s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f);
  return sign * middle > 0 &&
    sign * (this->TheField->ValueAt(s.Mesh.Position[u]) +
             this->TheField->ValueAt(s.Mesh.Position[v])) > 0;
}

bool Remesher::FlipBetween(int u, int v)
{
  SurfaceState& s = this->State;
  const Ring& ring = s.Mesh.Rings[u];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int a = ring.Item[i];
    const int b = ring.Next(i);
    if (s.Mesh.Rings[b].After(a) != v)
    {
      continue;
    }
    if (this->TheField)
    {
      // Joining u and v fills the fold where they are in front of each other, else cuts it off.
      const Vector middle = (s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f;
      const Vector edge = (s.Mesh.Position[a] + s.Mesh.Position[b]) * 0.5f;
      const bool fills = Dot(middle - edge, s.Normal[a].Axis() + s.Normal[b].Axis()) > 0;
      const float value = this->TheField->ValueAt((middle + edge) * 0.5f);
      if ((fills && value < 0) || (!fills && value > 0))
      {
        return false;
      }
    }
    return this->Editor.Flip(a, b, EditTolerance::Loose).IsDone;
  }
  return false;
}

void Remesher::Merge(const std::vector<Proximity::ClosePair>& pairs)
{
  SurfaceState& s = this->State;
  this->Sorted.clear();
  for (const Proximity::ClosePair& pair : pairs)
  {
    if (!s.Mesh.IsAlive(pair.V) || !s.Mesh.IsAlive(pair.W))
    {
      continue;
    }
    const float squared = SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]);
    const float near = s.Sizing.Clearance(pair.V, pair.W);
    if (squared < near * near)
    {
      this->Sorted.push_back(
        { std::min(pair.V, pair.W), std::max(pair.V, pair.W), squared });
    }
  }
  std::sort(this->Sorted.begin(), this->Sorted.end(),
    [](const Proximity::ClosePair& a, const Proximity::ClosePair& b)
    {
      return a.Squared != b.Squared ? a.Squared < b.Squared
                                    : (a.V != b.V ? a.V < b.V : a.W < b.W);
    });
  int lastV = -1;
  int lastW = -1;
  for (const Proximity::ClosePair& pair : this->Sorted)
  {
    if ((pair.V == lastV && pair.W == lastW) || !s.Mesh.IsAlive(pair.V) ||
      !s.Mesh.IsAlive(pair.W) || s.Mesh.AreNeighbours(pair.V, pair.W))
    {
      continue;
    }
    lastV = pair.V;
    lastW = pair.W;
    if (this->FlipBetween(pair.V, pair.W) || !this->TopologyChanges)
    {
      continue;
    }
    const Edit merge =
      this->IsMergeWanted(pair.V, pair.W) ? this->Editor.Merge(pair.V, pair.W) : Edit();
    if (merge)
    {
      // Bridge edges may be longer than eq. (1) allows, on which verification relies.
      this->Strip.assign(merge.Changed.begin(), merge.Changed.end());
      for (int v : this->Strip)
      {
        s.RemeshFlags[v] |= HasLongEdge;
      }
      this->Split(this->Strip);
    }
  }
}

void Remesher::CollapseAt(int v)
{
  SurfaceState& s = this->State;
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
      i = -1; // The ring has changed: look at it afresh.
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
  for (int v : vertices)
  {
    if (this->State.Mesh.IsAlive(v) && (this->State.RemeshFlags[v] & HasShortEdge))
    {
      if (this->State.Mesh.Rings[v].Count == 3 && this->Editor.Remove(v))
      {
        continue;
      }
      this->CollapseAt(v);
    }
  }
}

void Remesher::Flip(const std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  for (int v : vertices)
  {
    if (!s.Mesh.IsAlive(v) || !(s.RemeshFlags[v] & IsNotDelaunay))
    {
      continue;
    }
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
      if (Dot(p - a, q - a) * sineB + Dot(p - b, q - b) * sineA <
          LeastCotangentSum * sineA * sineB &&
        ring.Count > 3 && this->Editor.Flip(v, w, EditTolerance::Smooth))
      {
        --i;
      }
    }
  }
}

void Remesher::Unstick(const std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  for (int v : vertices)
  {
    if (!s.Mesh.IsAlive(v) || s.RollbackCount[v] < StuckRollbacks)
    {
      continue;
    }
    s.RollbackCount[v] = 0;
    if (s.Mesh.Rings[v].Count == 3 && this->Editor.Remove(v))
    {
      continue;
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
      continue;
    }
    for (float share : { 0.5f, 0.25f, 0.1f })
    {
      if (this->Editor.Move(v, p + (centre - p) * share, EditTolerance::Loose))
      {
        s.Velocity[v] = Vector();
        break;
      }
    }
  }
}
}
