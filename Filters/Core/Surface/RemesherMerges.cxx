// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Merges of Remesher, and the flips that close folds.

#include "Core/Surface/Remesher.h"

#include "Core/Common/Select.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace volumic
{
namespace
{
/** Largest cosine between the normals of two stars that face each other: 107 degrees. */
constexpr float FacingCosine = -0.3f;
/** Least cosine between the normal of a star and the line to the other one. */
constexpr float AheadCosine = 0.3f;

/** Order by distance, then by index. */
struct NearPair
{
  float Squared;
  int V; ///< Smaller index.
  int W;

  bool operator<(const NearPair& other) const
  {
    return this->Squared != other.Squared ? this->Squared < other.Squared
                                          : std::tie(this->V, this->W) < std::tie(other.V, other.W);
  }
  bool operator==(const NearPair& other) const { return this->V == other.V && this->W == other.W; }
};
}

bool Remesher::AreApproaching(int u, int v) const
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
  // In front: the gap is outside the object and would become part of it.
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
  const float middle = this->TheField->ValueAt((s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f);
  return sign * middle > 0 &&
    sign *
      (this->TheField->ValueAt(s.Mesh.Position[u]) + this->TheField->ValueAt(s.Mesh.Position[v])) >
    0;
}

bool Remesher::FlipBetween(int u, int v)
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
      // Joining u and v fills the fold if they are in front of each other, else cuts it off.
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

void Remesher::MergeOrFlip(int u, int v, std::vector<int>& strip)
{
  SurfaceState& s = this->State;
  if (!s.Mesh.IsAlive(u) || !s.Mesh.IsAlive(v) || s.Mesh.AreNeighbours(u, v) ||
    this->FlipBetween(u, v) || !this->TopologyChanges || !this->AreApproaching(u, v))
  {
    return;
  }
  const Edit merge = this->Editor.Merge(u, v);
  if (!merge)
  {
    return;
  }
  // Bridge edges may be longer than eq. (1) allows, but the intersection tests rely on it.
  std::vector<int> split(merge.Changed.begin(), merge.Changed.end());
  strip.insert(strip.end(), split.begin(), split.end());
  for (int w : split)
  {
    s.RemeshFlags[w] |= HasLongEdge;
  }
  for (std::size_t i = 0; i < split.size(); ++i)
  {
    this->SplitAt(split[i], split);
  }
}

void Remesher::Merge(const std::vector<Proximity::ClosePair>& pairs)
{
  const SurfaceState& s = this->State;
  std::vector<NearPair> near;
  for (const Proximity::ClosePair& pair : pairs)
  {
    if (!s.Mesh.IsAlive(pair.V) || !s.Mesh.IsAlive(pair.W))
    {
      continue;
    }
    const float clearance = s.Sizing.Clearance(pair.V, pair.W);
    const float squared = SquaredDistance(s.Mesh.Position[pair.V], s.Mesh.Position[pair.W]);
    if (squared < clearance * clearance)
    {
      near.push_back({ squared, std::min(pair.V, pair.W), std::max(pair.V, pair.W) });
    }
  }
  SortUnique(near);
  std::vector<int> strips;
  for (const NearPair& pair : near)
  {
    this->MergeOrFlip(pair.V, pair.W, strips);
  }
  this->Split(strips); // Edges that could not be split at once.
}
}
