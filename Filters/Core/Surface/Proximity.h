// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProximity_h
#define volumicProximity_h

#include "Core/Surface/SurfaceState.h"

#include <array>
#include <vector>

namespace volumic
{
/**
 * Finds close pairs of vertices for contacts and merges, marks vertices near others, and tests the
 * faces at these vertices for intersections, all in one search.
 *
 * Vertices that are near along a smooth surface are also near in space. Normals distinguish them: a
 * pair counts only if the cones of its face normals are opposed (SurfaceState::AreOpposed), as
 * those of the faces that touch first in a collision are. Positions, normals and grid must be up to
 * date. No edge may be longer than eq. (1) allows: intersecting faces then have corners within
 * SizingField::SearchRadius.
 */
class Proximity
{
public:
  /** Additional search radius of a slow vertex, which then needs a test less often. */
  static constexpr float ExtraSearchRadiusInDelta = 0.25f;

  struct ClosePair
  {
    int V;
    int W;
    float Squared; ///< Squared distance.
  };
  struct FacePair
  {
    std::array<int, 3> First;
    std::array<int, 3> Second;
  };
  /** Results for a span of the list. */
  struct Findings
  {
    std::vector<ClosePair> Pairs;
    std::vector<FacePair> Intersections;
    std::vector<int> Touching; ///< Corners of faces with no clearance.
  };

  /**
   * Compute Pairs, Intersections, and NearOthers and ClearanceAtTest of the listed vertices. Two
   * stars cannot intersect before one of them has moved by half of its clearance. The list is
   * processed in parallel; the result does not depend on the executor.
   */
  void Test(SurfaceState& state, const std::vector<int>& vertices, Executor& executor);

  /**
   * Return opposed pairs nearer than about lambda delta, grouped by V. A pair of two listed
   * vertices occurs twice. Pairs of vertices not in the last list are kept from earlier tests.
   */
  const std::vector<ClosePair>& Pairs() const { return this->AllPairs; }
  /** Find the pairs only, of vertices whose stars need no test. */
  void AddPairs(SurfaceState& state, const std::vector<int>& vertices);
  void Clear() { this->AllPairs.clear(); }

  /** Return pairs of intersecting faces. */
  const std::vector<FacePair>& Intersections() const { return this->AllIntersections; }

  /** Find intersecting faces at the vertices of a list. */
  static std::vector<FacePair> FindIntersections(
    SurfaceState& state, const std::vector<int>& vertices, Executor& executor);

private:
  std::vector<ClosePair> AllPairs;
  std::vector<FacePair> AllIntersections;
  std::vector<Findings> OfSpans; ///< Kept between calls to reuse memory.
};
}

#endif
