// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The merges of Remesher, and the flips that close folds.

#include "Core/Common/Blocks.h"
#include "Core/Common/Select.h"
#include "Core/Surface/Remesher.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace volumic
{
namespace
{
/** Cosine between the normals of two stars that just don't face each other: 107 degrees. */
constexpr float FacingCosine = -0.3f;
/** Least cosine between a star's normal and the line to the other one: it lies ahead or behind. */
constexpr float AheadCosine = 0.3f;
/** Of a merge: its bridge edges are split, as many as two rims have vertices. */
constexpr std::size_t PlacesForMerges = 64;
/** Pairs that one thread sorts at a time. */
constexpr std::size_t SortedBlock = 2048;

/** Nearest first, then by index. */
struct NearPair
{
  float Squared;
  int V; ///< The smaller one.
  int W;

  bool operator<(const NearPair& other) const
  {
    return this->Squared != other.Squared
      ? this->Squared < other.Squared
      : std::tie(this->V, this->W) < std::tie(other.V, other.W);
  }
  bool operator==(const NearPair& other) const
  {
    return this->V == other.V && this->W == other.W;
  }
};
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
  Select(
    this->Threads, pairs.size(), near,
    [&](std::size_t i)
    {
      const Proximity::ClosePair& pair = pairs[i];
      const float clearance = s.Sizing.Clearance(pair.V, pair.W);
      return s.Mesh.IsAlive(pair.V) && s.Mesh.IsAlive(pair.W) &&
        SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]) < clearance * clearance;
    },
    [](std::size_t i) { return static_cast<int>(i); });
  std::vector<NearPair> sorted(near.size());
  this->Threads.For(near.size(), SortedBlock,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Proximity::ClosePair& pair = pairs[near[i]];
        sorted[i] = { SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]),
          std::min(pair.V, pair.W), std::max(pair.V, pair.W) };
      }
    });
  SortInBlocks(this->Threads, sorted, SortedBlock);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());

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
}
