// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSizingField_h
#define volumicSizingField_h

#include <algorithm>

namespace volumic
{
/**
 * The lengths that the paper's eq. (1) and what we build on it allow, and the only one who knows
 * the invariant delta. It holds one delta for the whole surface; whoever asks names the vertices it
 * wants to know about, so that it may hold a delta for each of them without anybody noticing.
 *
 * Where nothing else is said a method's `share` is a factor of its length. Lengths: workspace.
 */
class SizingField
{
public:
  /** Factors of delta. */
  static constexpr float LongestEdgeInDelta = 2.5f;
  /** How many times shorter a division makes the edges, eq. (8). */
  static constexpr double DivisionFactor = 1.7320508075688772;
  /** sqrt 3: distance of two 26-connected voxels, in the unit of the level. */
  static constexpr double VoxelDiagonal = 1.7320508075688772;
  /**
   * Eq. (7): delta_h over U_h lies between this and 1, so that edges may be as short as the distance
   * of two 6-connected voxels and as long as that of two 26-connected ones.
   */
  static constexpr double LeastSamplingRatio = VoxelDiagonal / LongestEdgeInDelta;
  /** lambda of eq. (1): circumradius of the largest legal triangle. */
  static constexpr float LambdaInDelta = 1.4433757f;
  /** Two triangles of legal edges that intersect have two corners nearer than this. */
  static constexpr float ReachInDelta = 1.8f;
  /** In the middle of what eq. (1) allows; the springs rest there. */
  static constexpr float RestLengthInDelta = 1.6f;
  /** Triangles nearer than this count as intersecting: rounding must not make them so later. */
  static constexpr double ContactInDelta = 1e-4;

  SizingField() = default;
  /** @param delta delta_h of the level, eq. (7) */
  explicit SizingField(float delta)
    : LevelDelta(delta)
  {
  }

  /** The same, but nowhere less than what makes edges of this length legal. */
  SizingField ForEdgesOf(float length) const
  {
    return SizingField(std::max(this->LevelDelta, length / LongestEdgeInDelta));
  }

  /** Of the level as a whole: where there is no vertex yet, and for what is told of it. */
  float OfLevel() const { return this->LevelDelta; }
  float Smallest() const { return this->LevelDelta; }
  float Largest() const { return this->LevelDelta; }

  /** delta about a vertex: what forces, steps and tolerances there are measured in. */
  float At(int) const { return this->LevelDelta; }

  /** Eq. (1): bounds of the edge (u, v), which need not be there yet. */
  float ShortestEdge(int, int) const { return this->LevelDelta; }
  float LongestEdge(int, int, float share = 1) const
  {
    return share * LongestEdgeInDelta * this->LevelDelta;
  }
  /** Length of the edge (u, v) in delta: eq. (1) allows 1 to LongestEdgeInDelta. */
  float InDelta(int, int, float length) const { return length / this->LevelDelta; }
  float RestLength(int, int) const { return RestLengthInDelta * this->LevelDelta; }

  /** Eq. (1): lambda delta, how near two vertices may be that are far apart on the surface. */
  float Clearance(int, int, float share = 1) const
  {
    return share * LambdaInDelta * this->LevelDelta;
  }
  /** The largest that Clearance(v, w) is for any w. */
  float LargestClearance(int, float share = 1) const
  {
    return share * LambdaInDelta * this->LevelDelta;
  }

  /** Two intersecting triangles, one of them at v, have corners nearer than this. */
  float Reach(int) const { return ReachInDelta * this->LevelDelta; }
  float LargestReach() const { return ReachInDelta * this->LevelDelta; }

  /** Triangles with v as a corner that are nearer than this to others count as intersecting. */
  double Contact(int) const { return ContactInDelta * this->LevelDelta; }

private:
  float LevelDelta = 1;
};
}

#endif
