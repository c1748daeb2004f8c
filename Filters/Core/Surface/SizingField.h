// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSizingField_h
#define volumicSizingField_h

#include "Core/Common/ScratchMemory.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
/**
 * The lengths that the paper's eq. (1) and what we build on it allow, and the only one who knows
 * the invariant delta: one for the whole surface, or, where it is graded, one for each vertex. That
 * of an edge is the mean of its ends'; edges lie in [1, 2.5] of it.
 *
 * The delta of a graded surface grows by at most the gradation g for each length, along the surface
 * and across space. The longest legal edge about a vertex u is then 2.5 delta_u / (1 - 1.25 g), as
 * its delta is the mean of both ends'. A face with a corner at a distance d from u has edges of up to
 * 2.5 (delta_u + g d), and no point of it is further from a corner than that over sqrt 3. So what may
 * intersect is looked for Further() times as far: a little more than that comes to; no further than
 * where all have the largest delta. Derived in Documentation/differences.md.
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

  /**
   * The same, graded: a vertex has a delta of its own, from that of the level to `most`.
   * @param sizes by vertex, which stay where they are
   * @param gradation 1: they may differ as they like, and what may intersect is looked for as far
   *        as where all have the largest
   */
  SizingField Graded(const LargeVector<float>& sizes, float most, float gradation) const
  {
    SizingField graded(this->LevelDelta);
    graded.OfVertices = &sizes;
    graded.Most = std::max(most, this->LevelDelta);
    const float length = LongestEdgeInDelta * gradation;
    graded.HasGradation = gradation < 1.f;
    graded.TimesFurther = graded.HasGradation
      ? (std::exp(length) - 1.f) / (length * (1.f - gradation))
      : graded.Most / graded.LevelDelta;
    return graded;
  }
  bool IsGraded() const { return this->OfVertices != nullptr; }
  /** Whether it is, and its delta grows by no more than a gradation. */
  bool KeepsGradation() const { return this->HasGradation; }
  /** How many times further what may intersect is than where all are alike. */
  float Further() const { return this->TimesFurther; }
  /** A length in delta that something about a vertex reaches, so many times further. */
  float FurtherThan(int v, float inDelta) const
  {
    return inDelta * std::min(this->TimesFurther * this->At(v), this->Largest());
  }

  /** Of the level as a whole: where there is no vertex yet, and for what is told of it. */
  float OfLevel() const { return this->LevelDelta; }
  float Smallest() const { return this->LevelDelta; }
  float Largest() const { return this->OfVertices ? this->Most : this->LevelDelta; }

  /** delta about a vertex: what forces, steps and tolerances there are measured in. */
  float At(int v) const
  {
    return this->OfVertices
      ? std::clamp((*this->OfVertices)[v], this->LevelDelta, this->Most)
      : this->LevelDelta;
  }
  /** delta of an edge (u, v), which need not be there yet. */
  float OfEdge(int u, int v) const
  {
    return this->OfVertices ? 0.5f * (this->At(u) + this->At(v)) : this->LevelDelta;
  }

  /** Eq. (1): bounds of the edge (u, v). */
  float ShortestEdge(int u, int v) const { return this->OfEdge(u, v); }
  float LongestEdge(int u, int v, float share = 1) const
  {
    return share * LongestEdgeInDelta * this->OfEdge(u, v);
  }
  /** Length of the edge (u, v) in delta: eq. (1) allows 1 to LongestEdgeInDelta. */
  float InDelta(int u, int v, float length) const { return length / this->OfEdge(u, v); }
  float RestLength(int u, int v) const { return RestLengthInDelta * this->OfEdge(u, v); }

  /** Eq. (1): lambda delta, how near two vertices may be that are far apart on the surface. */
  float Clearance(int u, int v, float share = 1) const
  {
    return share * LambdaInDelta * std::min(this->At(u), this->At(v));
  }
  /** The largest that Clearance(v, w) is for any w. */
  float LargestClearance(int v, float share = 1) const
  {
    return share * LambdaInDelta * this->At(v);
  }

  /** Two intersecting triangles, one of them at v, have corners nearer than this. */
  float Reach(int v) const { return this->FurtherThan(v, ReachInDelta); }
  float SmallestReach() const { return ReachInDelta * this->LevelDelta; }
  float LargestReach() const { return ReachInDelta * this->Largest(); }

  /** Triangles with v as a corner that are nearer than this to others count as intersecting. */
  double Contact(int) const { return ContactInDelta * this->LevelDelta; }

private:
  float LevelDelta = 1;
  float Most = 1;
  float TimesFurther = 1;
  bool HasGradation = false;
  const LargeVector<float>* OfVertices = nullptr; ///< Null: all have that of the level.
};
}

#endif
