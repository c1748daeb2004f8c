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
 * Lengths of the paper's eq. (1) and derived lengths, from the invariant delta: one value for the
 * whole surface, or one per vertex if it is graded. delta of an edge is the mean of its ends. Edge
 * lengths lie in [1, 2.5] delta. No other class computes such lengths. Unit: computational space.
 *
 * delta of a graded surface grows by at most the gradation g per unit length, along the surface and
 * through space. The longest legal edge at a vertex u is then 2.5 delta_u / (1 - 1.25 g). A face
 * with a corner at a distance d from u has edges of up to 2.5 (delta_u + g d), and no point of it
 * is further than 1 / sqrt 3 of that from a corner. Search radii are therefore multiplied by
 * RadiusFactor(), a little more than these bounds, but limited to the radius for the largest delta.
 * Derived in Documentation/differences.md.
 */
class SizingField
{
public:
  static constexpr float LongestEdgeInDelta = 2.5f;
  /** Reduction factor of the edge length in a division, eq. (8). */
  static constexpr double DivisionFactor = 1.7320508075688772;
  /** sqrt 3: distance of 26-connected voxels, in the unit of the level. */
  static constexpr double VoxelDiagonal = 1.7320508075688772;
  /**
   * Eq. (7): delta_h / U_h lies between this and 1. Edges may be as short as the distance of
   * 6-connected voxels and as long as that of 26-connected ones.
   */
  static constexpr double LeastSamplingRatio = VoxelDiagonal / LongestEdgeInDelta;
  /** lambda of eq. (1): circumradius of the largest legal triangle. */
  static constexpr float LambdaInDelta = 1.4433757f;
  /** Two intersecting triangles of legal edges have two corners nearer than this. */
  static constexpr float SearchRadiusInDelta = 1.8f;
  /** Rest length of the springs, in the middle of the range of eq. (1). */
  static constexpr float RestLengthInDelta = 1.6f;
  /** Triangles nearer than this count as intersecting, as a margin for later rounding. */
  static constexpr double ContactInDelta = 1e-4;

  SizingField() = default;
  /** @param delta delta_h of the level, eq. (7) */
  explicit SizingField(float delta) : LevelDelta(delta) {}

  /** Return a field whose delta is large enough for edges of this length to be legal. */
  SizingField ForEdgesOf(float length) const
  {
    return SizingField(std::max(this->LevelDelta, length / LongestEdgeInDelta));
  }

  /**
   * Return a graded field, with a delta per vertex from that of the level to `most`.
   * @param sizes delta by vertex; must outlive the field
   * @param gradation 1: unlimited; search radii are then those of the largest delta
   */
  SizingField Graded(const LargeVector<float>& sizes, float most, float gradation) const
  {
    SizingField graded(this->LevelDelta);
    graded.OfVertices = &sizes;
    graded.Most = std::max(most, this->LevelDelta);
    const float length = LongestEdgeInDelta * gradation;
    graded.HasGradation = gradation < 1.f;
    graded.TheRadiusFactor = graded.HasGradation
      ? (std::exp(length) - 1.f) / (length * (1.f - gradation))
      : graded.Most / graded.LevelDelta;
    return graded;
  }
  bool IsGraded() const { return this->OfVertices != nullptr; }
  /** Return whether the field is graded and its delta grows by at most a gradation. */
  bool KeepsGradation() const { return this->HasGradation; }
  /** Return the ratio of search radii to those of a uniform surface. */
  float RadiusFactor() const { return this->TheRadiusFactor; }
  /** Return a search radius about a vertex, given in delta, times RadiusFactor(). */
  float ScaledRadius(int v, float inDelta) const
  {
    return inDelta * std::min(this->TheRadiusFactor * this->At(v), this->Largest());
  }

  /** Return delta of the level, the least of all vertices. */
  float OfLevel() const { return this->LevelDelta; }
  float Smallest() const { return this->LevelDelta; }
  float Largest() const { return this->OfVertices ? this->Most : this->LevelDelta; }

  /** Return delta at a vertex, the unit of forces, steps and tolerances. */
  float At(int v) const
  {
    return this->OfVertices ? std::clamp((*this->OfVertices)[v], this->LevelDelta, this->Most)
                            : this->LevelDelta;
  }
  /** Return delta of an edge (u, v), which need not exist. */
  float OfEdge(int u, int v) const
  {
    return this->OfVertices ? 0.5f * (this->At(u) + this->At(v)) : this->LevelDelta;
  }

  /** Return the bounds of the edge (u, v), eq. (1). */
  float ShortestEdge(int u, int v) const { return this->OfEdge(u, v); }
  float LongestEdge(int u, int v, float factor = 1) const
  {
    return factor * LongestEdgeInDelta * this->OfEdge(u, v);
  }
  /** Return the length of the edge (u, v) in delta. Eq. (1) allows 1 to LongestEdgeInDelta. */
  float InDelta(int u, int v, float length) const { return length / this->OfEdge(u, v); }
  float RestLength(int u, int v) const { return RestLengthInDelta * this->OfEdge(u, v); }

  /** Return lambda delta, eq. (1): least distance of two vertices far apart on the surface. */
  float Clearance(int u, int v, float factor = 1) const
  {
    return factor * LambdaInDelta * std::min(this->At(u), this->At(v));
  }
  /** Return the maximum of Clearance(v, w) over all w. */
  float LargestClearance(int v, float factor = 1) const
  {
    return factor * LambdaInDelta * this->At(v);
  }

  /** Return the distance within which intersecting triangles, one of them at v, have corners. */
  float SearchRadius(int v) const { return this->ScaledRadius(v, SearchRadiusInDelta); }
  float SmallestSearchRadius() const { return SearchRadiusInDelta * this->LevelDelta; }
  float LargestSearchRadius() const { return SearchRadiusInDelta * this->Largest(); }

  /** Return the distance below which triangles at v count as intersecting. */
  double Contact(int) const { return ContactInDelta * this->LevelDelta; }

private:
  float LevelDelta = 1;
  float Most = 1;
  float TheRadiusFactor = 1;
  bool HasGradation = false;
  const LargeVector<float>* OfVertices = nullptr; ///< Null: uniform.
};
}

#endif
