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
 * Sizing: the delta of each vertex for which faces keep a tolerance, or thin parts are resolved. It
 * follows from the measured distance of faces to the isosurface, which grows with the square of the
 * edge length. Lengths are in the computational space.
 *
 * CGAL's Adaptive_sizing_field and MMG's hausd use the curvature instead, which fails on noise.
 */
class GradedSizes
{
public:
  GradedSizes(SurfaceState& state, const Field& field, const Grading& grading, Executor& executor);

  /** Set all sizes to delta, or the nearest allowed value. The mesh must be laid out. */
  void Begin(float delta);
  /** Allow the largest sizes from now on, within the gradation. */
  void Widen();

  /**
   * Compute the sizes that faces need after they have moved from the coarser level onto the
   * isosurface of this one. @return vertices with changed sizes
   */
  std::vector<int> Refine();
  /** Set the smallest size near these positions, where recovery surfaces will lie. */
  std::vector<int> ShrinkNear(const std::vector<Vector>& positions);

  /**
   * Change sizes towards the tolerance, by factors in [1 / sqrt 3, growth], within the limits of
   * walls and gradation. @return vertices with changed sizes
   */
  std::vector<int> Adjust(float growth);

  /** Measure the distances of face centroids and edge midpoints to the isosurface. */
  Fit Measure() const;
  /**
   * Return the thickness at a converged vertex along its normal: of the object inward or of the gap
   * outward, whichever is less, clamped to Grading::MostThickness.
   */
  float ThicknessAt(int v) const;

private:
  /** A value per vertex, written in parallel. */
  using Largest = LargeVector<std::atomic<float>>;

  /**
   * Return the distance to the isosurface along the normal, at most Furthest(); negative inside the
   * object.
   */
  float SignedDistanceAt(const Vector& position, const Vector& normal) const;
  float Furthest() const;
  /**
   * Call visit(position, corners) for the centroid of each face and the midpoint of each edge of a
   * range of vertices.
   */
  template <typename Visit>
  void VisitMiddles(std::size_t begin, std::size_t end, const Visit& visit) const;
  /** Return for each vertex the largest value of `of` at the midpoints around it. */
  template <typename OfMiddle>
  Largest LargestAbout(const OfMiddle& of) const;
  /**
   * Return the distance to the opposite wall of the object (side -1) or the gap (side 1) along the
   * normal, in [from, most].
   */
  float DistanceToWall(int v, float side, float from, float most) const;
  /** Return the largest size that the thickness of object and gap allows. */
  float MostBetweenWalls(int v, float size) const;
  /** @param distance largest distance to the isosurface around the vertex */
  float RequestedSize(int v, float distance, float growth) const;
  /** @param offset SignedDistanceAt() @param sag distance without the offsets */
  float RefinedSize(int v, float offset, float sag) const;
  /** Set requested sizes, limited by the gradation. @return vertices with changed sizes */
  std::vector<int> Change(const std::function<float(int v)>& requested);

  SurfaceState& State;
  const Field& TheField;
  const Grading Requested;
  Executor& Threads;
  const float Near; ///< Up to this, distances are estimated from value and slope.
  const float Least;
  const float Most;
};
}

#endif
