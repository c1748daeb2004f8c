// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceEdits_h
#define volumicInterfaceEdits_h

#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * Edits of interfaces that keep what meets where: junction lines and points stay, and each object's
 * surface keeps its topology. None makes triangles intersect: each is tried by itself.
 *
 * - Splits are at the middle of an edge, of all faces at it.
 * - Collapses take a vertex into another of its stratum, or of a higher one: from an interface into
 *   anything, along a junction line into one of its vertices, or its end. Vertices that have both
 *   ends as neighbours must be those of the faces at the edge (the link condition), and at most one
 *   edge of these faces may be of a junction line. Two junction points must have no object in
 *   common but those at their edge.
 * - Flips are between two faces of the same objects.
 * - In the sides of a periodic box all images of an edge or vertex are edited, or none is.
 */
class InterfaceEdits
{
public:
  /** Of edges at corners, by how much they may be longer than others for a while. */
  static constexpr double CornerClearance = 4. / 3.;

  /**
   * @param clearance of the mesh as it is, for all edits but splits, which change nothing for
   * anybody
   * @param shortest, longest between which edges are wanted, times the mesh's sizes; lengths of the
   *                  workspace
   */
  InterfaceEdits(
    InterfaceMesh& mesh, InterfaceClearance& clearance, double shortest, double longest);

  /** Of the longest edge of a face that is there, if it is too long. */
  bool TrySplit(int face);
  /** Of all short edges of a face. @return how many were collapsed */
  int CollapseAt(int face);
  /** Of one edge of a face that is there. @return how many were flipped */
  int FlipAt(int face);
  /** Of a triangle with a small angle the longest edge is flipped, or the shortest collapsed. */
  bool RemoveSliver(int face);

private:
  bool MayCollapse(int u, int v);
  /** Whether objects that are at both ends of the edge, AtEdge, are beside it: none is pinched. */
  bool ShareObjects(int u, int v);
  /** With the vertex in the middle, where both are alike, or at either end. */
  bool TryCollapse(int u, int v);
  /** Of all Images of the edge: whether it may, at a place would be fair, and to that. */
  bool MayCollapseImages();
  bool AreFairCollapses(const Vector& place);
  void CollapseImages(const Vector& place);
  /** Where the vertex that an image keeps is, if that of the first one is at a place. */
  Vector PositionOfImage(std::size_t image, const Vector& place) const;
  /** Adds what the faces of both would be to Made, and which these are to Changed. */
  bool IsFairCollapse(const Vector& place, int kept, int removed);
  bool MakesLongEdges(const Vector& place, int kept, int removed) const;
  void Collapse(const Vector& place, int kept, int removed);
  /** @param flatness cosine of the angle that there may be between the faces */
  bool TryFlip(int u, int v, double flatness);
  /** Adds the faces to Changed, and what they would be to Made. */
  bool IsFairFlip(int u, int v, double flatness);
  void Split(int u, int v);
  int SplitOne(int u, int v); ///< the vertex that it adds
  float SquaredEdge(int u, int v) const
  {
    return SquaredDistance(this->Mesh.Position[static_cast<std::size_t>(u)],
      this->Mesh.Position[static_cast<std::size_t>(v)]);
  }
  float SquaredSize(int u, int v) const
  {
    const float size = this->Mesh.SizeOf(u, v);
    return size * size;
  }

  /** Cosine of the angle by which an edit may turn a face. */
  static constexpr double LeastTurnCosine = 0.4;

  InterfaceMesh& Mesh;
  InterfaceClearance& Clearance;
  float Shortest; ///< squared, where sizes are 1
  float Longest;  ///< squared, where sizes are 1
  std::vector<int> AtEdge;
  std::vector<int> Changed;
  std::vector<std::array<int, 2>> Images; ///< of the edge, that which is kept first, or the vertex
  std::vector<int> Near;
  std::vector<int> First;
  std::vector<int> Second;
  std::vector<int> Common; ///< of these two
  std::vector<FaceCoordinates> Made;
};
}

#endif
