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
}

bool Remesher::SplitEdge(int u, int v, std::vector<int>& added, int depth)
{
  SurfaceState& s = this->State;
  if (!s.Mesh.AreNeighbours(u, v))
  {
    return true; // Split on the way to another one.
  }
  int m = this->Editor.Split(u, v);
  if (m < 0 && depth > 0)
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
    m = this->Editor.Split(u, v);
  }
  if (m >= 0)
  {
    s.Wants[m] = SurfaceState::Shorter; // Checked when the walk reaches it.
    added.push_back(m);
  }
  return m >= 0;
}

void Remesher::Split(std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  const float longest = constraint::LongestEdge * s.Delta;
  // The list grows while it is walked: new vertices may have long edges of their own.
  for (std::size_t n = 0; n < vertices.size(); ++n)
  {
    const int v = vertices[n];
    if (!s.Mesh.IsAlive(v) || !(s.Wants[v] & SurfaceState::Shorter))
    {
      continue;
    }
    bool blocked = false;
    for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
    {
      const int w = s.Mesh.Rings[v].Item[i];
      if (SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) > longest * longest)
      {
        blocked = !this->SplitEdge(v, w, vertices, DeepestSplit) || blocked;
      }
    }
    if (!blocked)
    {
      s.Wants[v] &= static_cast<std::uint8_t>(~SurfaceState::Shorter);
    }
  }
}

bool Remesher::WantsMerge(int u, int v) const
{
  const SurfaceState& s = this->State;
  const Vector across = s.Mesh.Position[v] - s.Mesh.Position[u];
  const float distance = Length(across);
  if (distance <= 0 || Dot(s.Normal[u], s.Normal[v]) > -0.3f)
  {
    return false;
  }
  // In front of each other: the gap is outside and would become part of the object.
  const float ahead = Dot(s.Normal[u], across) / distance;
  const float back = -Dot(s.Normal[v], across) / distance;
  const bool front = ahead > 0.3f && back > 0.3f;
  const bool behind = ahead < -0.3f && back < -0.3f;
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
      const bool fills = Dot(middle - edge, s.Normal[a] + s.Normal[b]) > 0;
      const float value = this->TheField->ValueAt((middle + edge) * 0.5f);
      if ((fills && value < 0) || (!fills && value > 0))
      {
        return false;
      }
    }
    return this->Editor.FlipForConstraint(a, b);
  }
  return false;
}

void Remesher::Merge(const std::vector<Proximity::ClosePair>& pairs)
{
  SurfaceState& s = this->State;
  this->Sorted.clear();
  const float near = constraint::NearestOthers * s.Delta;
  for (const Proximity::ClosePair& pair : pairs)
  {
    if (!s.Mesh.IsAlive(pair.V) || !s.Mesh.IsAlive(pair.W))
    {
      continue;
    }
    const float squared = SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]);
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
    const std::size_t touched = s.Touched.size();
    if (this->WantsMerge(pair.V, pair.W) && this->Editor.Merge(pair.V, pair.W))
    {
      // Rungs of the band may be longer than eq. (1) allows, on which verification relies.
      this->Band.assign(
        s.Touched.begin() + static_cast<std::ptrdiff_t>(touched), s.Touched.end());
      for (int v : this->Band)
      {
        s.Wants[v] |= SurfaceState::Shorter;
      }
      this->Split(this->Band);
    }
  }
}

void Remesher::CollapseAt(int v)
{
  SurfaceState& s = this->State;
  for (int i = 0; i < s.Mesh.Rings[v].Count; ++i)
  {
    const int w = s.Mesh.Rings[v].Item[i];
    if (SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) >= s.Delta * s.Delta)
    {
      continue;
    }
    const int a = s.Mesh.Rings[v].Next(i);
    const int b = s.Mesh.Rings[v].Previous(i);
    const bool removedA = s.Mesh.Rings[a].Count == 3 && this->Editor.Remove(a);
    const bool removedB = s.Mesh.Rings[b].Count == 3 && this->Editor.Remove(b);
    if (removedA || removedB)
    {
      i = -1; // The ring has changed: look at it afresh.
      continue;
    }
    const EdgeCollapse collapse{ v, w };
    if (collapse.IsLegal(s.Mesh))
    {
      if (this->Editor.Collapse(v, w, SurfaceEditor::Care::Smooth))
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
    if (this->State.Mesh.IsAlive(v) && (this->State.Wants[v] & SurfaceState::Longer))
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
    if (!s.Mesh.IsAlive(v) || !(s.Wants[v] & SurfaceState::Flip))
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
      if (Dot(p - a, q - a) * sineB + Dot(p - b, q - b) * sineA < -0.05f * sineA * sineB &&
        ring.Count > 3 && this->Editor.FlipForShape(v, w))
      {
        --i;
      }
    }
  }
}

void Remesher::Unstick(const std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  constexpr int limit = 6;
  for (int v : vertices)
  {
    if (!s.Mesh.IsAlive(v) || s.Stuck[v] < limit)
    {
      continue;
    }
    s.Stuck[v] = 0;
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
    const float close = 1.3f * s.Delta;
    if (SquaredDistance(p, s.Mesh.Position[nearest]) < close * close &&
      this->Editor.Collapse(v, nearest, SurfaceEditor::Care::Rough))
    {
      continue;
    }
    for (float share : { 0.5f, 0.25f, 0.1f })
    {
      if (this->Editor.Move(v, p + (centre - p) * share, SurfaceEditor::Care::Rough))
      {
        s.Velocity[v] = Vector();
        break;
      }
    }
  }
}
}
