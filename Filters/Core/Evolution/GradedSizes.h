// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGradedSizes_h
#define volumicGradedSizes_h

#include "Core/Common/Executor.h"
#include "Core/Common/Grading.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * The delta that each vertex of a surface should have, so that its faces keep a tolerance, or thin
 * parts are held: found from how far they are from the isopotential as they are. The distance of a
 * face's middle grows with the square of its edges. Lengths: workspace.
 *
 * The peers take the curvature alone (CGAL's Adaptive_sizing_field, MMG's hausd); what is measured
 * holds where the curvature is that of noise, too.
 */
class GradedSizes
{
public:
  GradedSizes(SurfaceState& state, const Field& field, const Grading& grading, Executor& executor);

  /** All sizes become this one, or the nearest that is allowed; the mesh must be laid out. */
  void Begin(float delta);
  /** From here on sizes may become as large as is allowed; they keep the gradation. */
  void Widen();

  /**
   * Of a surface that comes from a coarser level: those that its faces, moved onto the isopotential
   * of this one, would need. @return whose has changed
   */
  std::vector<int> Refine();
  /** The least about these places, as far as what would be enclosed there reaches. */
  std::vector<int> ShrinkNear(const std::vector<Vector>& places);

  /**
   * Changes the sizes towards what keeps the tolerance, each by a factor of at most `growth`, and
   * at least 1 / sqrt 3; none beyond what walls and the gradation allow. @return whose has changed
   */
  std::vector<int> Adjust(float growth);

  /** How far faces are from the isopotential, at their centroids and the middles of their edges. */
  Fit Measure() const;
  /**
   * The lesser of what the object measures along the normal of a vertex at rest, inward, and the
   * air, outward; no more than Grading::MostThickness of the least delta are looked through.
   */
  float ThicknessAt(int v) const;

private:
  /** Of each vertex, written by many threads. */
  using Largest = LargeVector<std::atomic<float>>;

  /**
   * From a point of the surface with this normal, at most Furthest(); negative on the object's side
   * of the isopotential.
   */
  float SignedDistanceAt(const Vector& position, const Vector& normal) const;
  float Furthest() const;
  /**
   * Calls visit(place, corners) for the centroid of each face and the middle of each edge; those of
   * all ranges are all.
   */
  template <typename Visit>
  void VisitMiddles(std::size_t begin, std::size_t end, const Visit& visit) const;
  /** For each vertex the largest value of `of` at the middles about it. */
  template <typename OfMiddle>
  Largest LargestAbout(const OfMiddle& of) const;
  /**
   * How far the next side of the object (side -1), or of the air (1), is along the normal: at least
   * `from`, at most `most`.
   */
  float DistanceToWall(int v, float side, float from, float most) const;
  /** What the thickness of the object, or of the air in it, allows. */
  float MostBetweenWalls(int v, float size) const;
  /** @param distance of what is furthest from the isopotential about it */
  float RequestedSize(int v, float distance, float growth) const;
  /** @param offset its SignedDistanceAt @param sag the distance, once the offsets are gone */
  float RefinedSize(int v, float offset, float sag) const;
  /** Gives all vertices what `wanted` tells, as far as the gradation allows. @return see Adjust */
  std::vector<int> Change(const std::function<float(int v)>& requested);

  SurfaceState& State;
  const Field& TheField;
  const Grading Requested;
  Executor& Threads;
  const float Near; ///< Distances up to this are told from value and slope.
  const float Least;
  const float Most;
};
}

#endif
