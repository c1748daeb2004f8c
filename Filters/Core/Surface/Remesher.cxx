// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Remesher.h"

#include "Core/Common/Select.h"
#include "Core/Mesh/EdgeCollapse.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Splits that may have to come before one, see SplitEdge. */
constexpr int DeepestSplit = 4;
/** How near an edge's middle may be to what lies opposite, in delta; see MakesNeedles. */
constexpr float LeastHeight = 0.02f;
/** Roll backs after which a vertex counts as stuck. */
constexpr int StuckRollbacks = 6;
/** Longest edge of a stuck vertex that is collapsed, of the shortest legal edge. */
constexpr float StuckCollapse = 1.3f;

// Places for new vertices that a cell gets at a time; what does not find one waits for a next round.
/** A vertex with long edges seldom has more than three of them. */
constexpr std::size_t PlacesPerSplit = 3;
constexpr std::size_t PlacesForSplits = 16;
/** Of a few cuts, three each. */
constexpr std::size_t PlacesForCuts = 24;
}

std::vector<int> Remesher::Flagged(const std::vector<int>& vertices, RemeshFlag flag) const
{
  const SurfaceState& s = this->State;
  return SelectOf(this->Threads, vertices,
    [&s, flag](int v) { return s.Mesh.IsAlive(v) && (s.RemeshFlags[v] & flag) != 0; });
}

bool Remesher::MakesNeedles(int u, int v, const EdgeFlip& across) const
{
  // Where the longest edge of a triangle cannot be split, its two others would be in turn, each
  // middle a quarter as far from the last one, until all lie on a line: triangles without height,
  // whose sides no test can tell. An edge that is too long for a while does no harm.
  const SurfaceState& s = this->State;
  const Vector middle = (s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f;
  const float least = LeastHeight * s.Sizing.ShortestEdge(u, v);
  return SquaredDistance(middle, s.Mesh.Position[across.A]) < least * least ||
    SquaredDistance(middle, s.Mesh.Position[across.B]) < least * least;
}

bool Remesher::SplitEdge(
  SurfaceEditor& editor, int u, int v, std::vector<int>& added, int depth) const
{
  SurfaceState& s = this->State;
  if (!s.Mesh.AreNeighbours(u, v))
  {
    return true; // Split on the way to another one.
  }
  const EdgeFlip across = EdgeFlip::Of(s.Mesh, u, v);
  if (this->MakesNeedles(u, v, across))
  {
    return false;
  }
  Edit split = editor.Split(u, v);
  if (!split && depth > 0)
  {
    // A vertex opposite to the edge has no room for another neighbour. Once an edge from it to one
    // of the ends is split, that one's middle is what lies opposite.
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
