// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Remesher.h"

#include "Core/Common/Select.h"
#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

// Places for new vertices that a cell gets at a time; what does not find one waits for a next round.
/** A vertex with long edges seldom has more than three of them. */
constexpr std::size_t PlacesPerSplit = 3;
constexpr std::size_t PlacesForSplits = 16;
/** Of a merge: its bridge edges are split, as many as two rims have vertices. */
constexpr std::size_t PlacesForMerges = 64;
/** Of a few cuts, three each. */
constexpr std::size_t PlacesForCuts = 24;
}

std::vector<int> Remesher::Flagged(const std::vector<int>& vertices, RemeshFlag flag) const
{
  const SurfaceState& s = this->State;
  return SelectOf(this->Threads, vertices,
    [&s, flag](int v) { return s.Mesh.IsAlive(v) && (s.RemeshFlags[v] & flag) != 0; });
}

bool Remesher::SplitEdge(
  SurfaceEditor& editor, int u, int v, std::vector<int>& added, int depth) const
{
  SurfaceState& s = this->State;
  if (!s.Mesh.AreNeighbours(u, v))
  {
    return true; // Split on the way to another one.
  }
  Edit split = editor.Split(u, v);
  if (!split && depth > 0)
  {
    // A vertex opposite to the edge has no room for another neighbour. Once an edge from it to one
    // of the ends is split, that one's middle is what lies opposite.
    const EdgeFlip across = EdgeFlip::Of(s.Mesh, u, v);
    for (int full : { across.A, across.B })
    {
      if (s.Mesh.Rings[full].Count == Ring::Capacity &&
        !this->SplitEdge(editor, full, u, added, depth - 1))
      {
        this->SplitEdge(editor, full, v, added, depth - 1);
      }
    }
    if (!s.Mesh.AreNeighbours(u, v))
    {
      return true;
    }
    split = editor.Split(u, v);
  }
  if (split)
  {
    s.RemeshFlags[split.Vertex] = HasLongEdge; // Checked when the walk reaches it.
    added.push_back(split.Vertex);
  }
  return split.IsDone;
}

void Remesher::SplitAt(SurfaceEditor& editor, int v, std::vector<int>& added) const
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
      blocked = !this->SplitEdge(editor, v, w, added, DeepestSplit) || blocked;
    }
  }
  if (!blocked)
  {
    s.RemeshFlags[v] &= static_cast<std::uint8_t>(~(HasLongEdge | HasHugeEdge));
  }
}

float Remesher::LongestEdgeAt(const std::vector<int>& vertices) const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  float longest = 0;
  for (int v : vertices)
  {
    const Ring& ring = mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      longest =
        std::max(longest, SquaredDistance(mesh.Position[v], mesh.Position[ring.Item[i]]));
    }
  }
  return std::sqrt(longest);
}

void Remesher::Split(std::vector<int>& vertices)
{
  SurfaceState& s = this->State;
  EditCells::Pass pass;
  pass.Items = this->Flagged(vertices, HasLongEdge);
  const float longestBefore = s.LongestEdge;
  s.LongestEdge =
    std::max(longestBefore, this->LongestEdgeAt(this->Flagged(pass.Items, HasHugeEdge)));
  pass.PlacesPerItem = PlacesPerSplit;
  pass.PlacesPerCell = PlacesForSplits;
  // The list grows while it is walked: new vertices may have long edges of their own.
  pass.Visit = [this](SurfaceEditor& editor, int v, EditCells::Lists& lists)
  { this->SplitAt(editor, v, lists.Items); };
  this->Cells.Run(pass);
  if (this->Flagged(pass.Items, HasHugeEdge).empty())
  {
    s.LongestEdge = longestBefore;
  }
  vertices.insert(vertices.end(), this->Cells.Added().begin(), this->Cells.Added().end());
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

bool Remesher::FlipBetween(SurfaceEditor& editor, int u, int v) const
{
  const SurfaceState& s = this->State;
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
    return editor.Flip(a, b, EditTolerance::Loose).IsDone;
  }
  return false;
}

void Remesher::MergeOrFlip(SurfaceEditor& editor, int u, int v, std::vector<int>& strip) const
{
  SurfaceState& s = this->State;
  if (!s.Mesh.IsAlive(u) || !s.Mesh.IsAlive(v) || s.Mesh.AreNeighbours(u, v) ||
    this->FlipBetween(editor, u, v) || !this->TopologyChanges || !this->IsMergeWanted(u, v))
  {
    return;
  }
  const Edit merge = editor.Merge(u, v);
  if (!merge)
  {
    return;
  }
  // Bridge edges may be longer than eq. (1) allows, on which verification relies.
  std::vector<int> split(merge.Changed.begin(), merge.Changed.end());
  strip = split;
  for (int w : split)
  {
    s.RemeshFlags[w] |= HasLongEdge;
  }
  for (std::size_t i = 0; i < split.size(); ++i)
  {
    this->SplitAt(editor, split[i], split);
  }
}

void Remesher::Merge(const std::vector<Proximity::ClosePair>& pairs)
{
  const SurfaceState& s = this->State;
  std::vector<int> near;
  SelectValues(
    this->Threads, pairs.size(), near,
    [&](std::size_t i)
    {
      const Proximity::ClosePair& pair = pairs[i];
      const float clearance = s.Sizing.Clearance(pair.V, pair.W);
      return s.Mesh.IsAlive(pair.V) && s.Mesh.IsAlive(pair.W) &&
        SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]) < clearance * clearance;
    },
    [](std::size_t i) { return static_cast<int>(i); });
  std::vector<Proximity::ClosePair> sorted(near.size());
  for (std::size_t i = 0; i < near.size(); ++i)
  {
    const Proximity::ClosePair& pair = pairs[near[i]];
    sorted[i] = { std::min(pair.V, pair.W), std::max(pair.V, pair.W),
      SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]) };
  }
  const auto isBefore = [](const Proximity::ClosePair& a, const Proximity::ClosePair& b)
  {
    return a.Squared != b.Squared ? a.Squared < b.Squared
                                  : (a.V != b.V ? a.V < b.V : a.W < b.W);
  };
  std::sort(sorted.begin(), sorted.end(), isBefore);
  sorted.erase(std::unique(sorted.begin(), sorted.end(),
                 [](const Proximity::ClosePair& a, const Proximity::ClosePair& b)
                 { return a.V == b.V && a.W == b.W; }),
    sorted.end());

  EditCells::Pass pass;
  pass.Items.resize(sorted.size());
  std::iota(pass.Items.begin(), pass.Items.end(), 0);
  pass.VertexOf = [&sorted](int item) { return sorted[item].V; };
  pass.MarginInDelta = EditCells::MergeMargin;
  pass.PlacesPerCell = this->TopologyChanges ? PlacesForMerges : 0;
  pass.Visit = [this, &sorted](SurfaceEditor& editor, int item, EditCells::Lists& lists)
  {
    std::vector<int> strip;
    this->MergeOrFlip(editor, sorted[item].V, sorted[item].W, strip);
    lists.Kept.insert(lists.Kept.end(), strip.begin(), strip.end());
  };
  this->Cells.Run(pass);
  std::vector<int> strips = this->Cells.Kept();
  this->Split(strips); // What could not be split at once.
}

void Remesher::CollapseAt(SurfaceEditor& editor, int v) const
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
    const bool removedA = s.Mesh.Rings[a].Count == 3 && editor.Remove(a).IsDone;
    const bool removedB = s.Mesh.Rings[b].Count == 3 && editor.Remove(b).IsDone;
    if (removedA || removedB)
    {
      i = -1; // The ring has changed: look at it afresh.
      continue;
    }
    const EdgeCollapse collapse{ v, w };
    if (collapse.IsLegal(s.Mesh))
    {
      if (editor.Collapse(v, w, EditTolerance::Smooth))
      {
        i = -1;
      }
      continue;
    }
    const int c = collapse.ThirdCommonNeighbour(s.Mesh);
    if (c >= 0 && this->TopologyChanges && editor.Cut(v, w, c))
    {
      i = -1;
    }
  }
}

void Remesher::Collapse(const std::vector<int>& vertices)
{
  EditCells::Pass pass;
  pass.Items = this->Flagged(vertices, HasShortEdge);
  pass.PlacesPerCell = this->TopologyChanges ? PlacesForCuts : 0;
  pass.Visit = [this](SurfaceEditor& editor, int v, EditCells::Lists&)
  {
    const SurfaceMesh& mesh = this->State.Mesh;
    if (mesh.IsAlive(v) && !(mesh.Rings[v].Count == 3 && editor.Remove(v)))
    {
      this->CollapseAt(editor, v);
    }
  };
  this->Cells.Run(pass);
}

void Remesher::FlipAt(SurfaceEditor& editor, int v) const
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
    if (Dot(p - a, q - a) * sineB + Dot(p - b, q - b) * sineA <
        LeastCotangentSum * sineA * sineB &&
      ring.Count > 3 && editor.Flip(v, w, EditTolerance::Smooth))
    {
      --i;
    }
  }
}

void Remesher::Flip(const std::vector<int>& vertices)
{
  EditCells::Pass pass;
  pass.Items = this->Flagged(vertices, IsNotDelaunay);
  pass.Visit = [this](SurfaceEditor& editor, int v, EditCells::Lists&)
  {
    if (this->State.Mesh.IsAlive(v))
    {
      this->FlipAt(editor, v);
    }
  };
  this->Cells.Run(pass);
}

void Remesher::UnstickAt(SurfaceEditor& editor, int v) const
{
  SurfaceState& s = this->State;
  s.RollbackCount[v] = 0;
  if (s.Mesh.Rings[v].Count == 3 && editor.Remove(v))
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
    editor.Collapse(v, nearest, EditTolerance::Loose))
  {
    return;
  }
  for (float share : { 0.5f, 0.25f, 0.1f })
  {
    if (editor.Move(v, p + (centre - p) * share, EditTolerance::Loose))
    {
      s.Velocity[v] = Vector();
      break;
    }
  }
}

void Remesher::Unstick(const std::vector<int>& vertices)
{
  const SurfaceState& s = this->State;
  EditCells::Pass pass;
  pass.Items = SelectOf(this->Threads, vertices,
    [&s](int v) { return s.Mesh.IsAlive(v) && s.RollbackCount[v] >= StuckRollbacks; });
  pass.Visit = [this](SurfaceEditor& editor, int v, EditCells::Lists&)
  {
    if (this->State.Mesh.IsAlive(v))
    {
      this->UnstickAt(editor, v);
    }
  };
  this->Cells.Run(pass);
}
}
