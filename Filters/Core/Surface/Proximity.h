// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProximity_h
#define volumicProximity_h

#include "Core/Mesh/TriangleTests.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <vector>

namespace volumic
{
/**
 * What lies near what: finds the close pairs of vertices that contacts and merges work on, marks
 * the vertices near which an edit must be verified, and tests the triangles about all of them for
 * intersections, all in one search.
 *
 * Vertices near along a smooth surface are near in space too. They are told apart by the normals:
 * a pair counts only if the cones of the face normals about the two are opposed, since the faces
 * that meet first in a collision are (SurfaceState::AreOpposed). Positions, normals and grid must
 * be up to date, and no edge longer than 2.5 delta: triangles that meet then have corners within
 * 1.8 delta.
 */
class Proximity
{
public:
  struct ClosePair
  {
    int V;
    int W;
    float Squared; ///< Distance, squared.
  };
  struct Meeting
  {
    std::array<int, 3> First;
    std::array<int, 3> Second;
  };

  /**
   * Fills Pairs, Meetings, and Near and Slack of the vertices in the list. Slack is the room that
   * their stars have: while neither of two stars has moved by half of its slack they can't meet.
   */
  void Examine(SurfaceState& state, const std::vector<int>& vertices, Executor& executor);

  /**
   * Opposed pairs nearer than about lambda delta, grouped by V; a pair of two listed occurs twice.
   * Those of vertices that were not in the last list are kept from when they were.
   */
  const std::vector<ClosePair>& Pairs() const { return this->AllPairs; }
  /** Forgets the pairs, before the vertices are renumbered. */
  void Clear() { this->AllPairs.clear(); }

  /** Pairs of faces that intersect. */
  const std::vector<Meeting>& Meetings() const { return this->AllMeetings; }

private:
  struct Block
  {
    std::vector<ClosePair> Pairs;
    std::vector<Meeting> Meetings;
    std::vector<int> Tight; ///< Corners of faces without room.
  };
  void ExamineVertex(SurfaceState& state, int v, Block& block) const;

  std::vector<Block> Blocks;
  std::vector<ClosePair> AllPairs;
  std::vector<Meeting> AllMeetings;
  std::vector<std::uint8_t> Listed;
};

/** The faces an edit takes away: those with any of some vertices, or those with both of two. */
struct GoneFaces
{
  std::array<int, 6> Vertex;
  int Count = 0;
  bool Both = false;

  bool Contains(const std::array<int, 3>& face) const
  {
    int found = 0;
    for (int i = 0; i < this->Count; ++i)
    {
      const int v = this->Vertex[i];
      found += face[0] == v || face[1] == v || face[2] == v;
    }
    return found > (this->Both ? 1 : 0);
  }
};

/**
 * Whether any of the new triangles would meet another of them, or a face of the mesh that is not
 * gone. Nothing is changed.
 */
bool NewFacesMeet(
  const SurfaceState& state, const std::vector<MeshTriangle>& faces, const GoneFaces& gone);

/** The triangle with the positions of the mesh. */
MeshTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c);
}

#endif
