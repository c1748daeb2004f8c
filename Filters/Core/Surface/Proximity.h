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
 * What lies near what: finds the close pairs of vertices that contacts and merges work on, marks
 * the vertices that are near others, and tests the faces about all of them for intersections, all
 * in one search.
 *
 * Vertices near along a smooth surface are near in space too. They are told apart by the normals:
 * a pair counts only if the cones of the face normals about the two are opposed, since the faces
 * that touch first in a collision are (SurfaceState::AreOpposed). Positions, normals and grid must
 * be up to date, and no edge longer than eq. (1) allows: faces that intersect then have corners
 * within SizingField::Reach.
 */
class Proximity
{
public:
  /** By what a slow vertex looks further than its reach, and needs no new look for longer. */
  static constexpr float FurtherReachInDelta = 0.25f;

  struct ClosePair
  {
    int V;
    int W;
    float Squared; ///< Distance, squared.
  };
  struct FacePair
  {
    std::array<int, 3> First;
    std::array<int, 3> Second;
  };
  /** What is found of some vertices that follow each other in the list. */
  struct Findings
  {
    std::vector<ClosePair> Pairs;
    std::vector<FacePair> Intersections;
    std::vector<int> Tight; ///< Corners of faces that have no room left.
  };

  /**
   * Fills Pairs, Intersections, and NearOthers and Slack of the vertices in the list. Slack is the
   * room that their stars have: two stars can't intersect while neither has moved by half of it.
   * Threads share the list; what is found does not depend on them.
   */
  void Test(SurfaceState& state, const std::vector<int>& vertices, Executor& executor);

  /**
   * Opposed pairs nearer than about lambda delta, grouped by V; a pair of two listed occurs twice.
   * Those of vertices that were not in the last list are kept from when they were.
   */
  const std::vector<ClosePair>& Pairs() const { return this->AllPairs; }
  /** Finds the pairs alone, of vertices whose stars need no new look. */
  void AddPairs(SurfaceState& state, const std::vector<int>& vertices);
  /** Forgets the pairs. */
  void Clear() { this->AllPairs.clear(); }

  /** Pairs of faces that intersect. */
  const std::vector<FacePair>& Intersections() const { return this->AllIntersections; }

  /** Those about the vertices of a list alone. */
  static std::vector<FacePair> FindIntersections(
    SurfaceState& state, const std::vector<int>& vertices, Executor& executor);

private:
  std::vector<ClosePair> AllPairs;
  std::vector<FacePair> AllIntersections;
  std::vector<Findings> OfSpans; ///< Of the last list; kept for their memory.
};
}

#endif
