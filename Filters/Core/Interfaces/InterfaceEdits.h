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
 * Local edits of interfaces. They preserve junction lines and points and the topology of the
 * surface of each object. Each edit is verified before it is made, so that no triangles intersect.
 *
 * - A split inserts a vertex at the middle of an edge and splits all faces at the edge.
 * - A collapse merges a vertex into another one of the same or a higher stratum. A vertex of a
 *   junction line is merged along this line only. The link condition must hold: all common
 *   neighbours of both vertices are in faces at the edge. At most one edge of these faces may be on
 *   a junction line. Two junction points must not share an object that is not at their edge.
 * - A flip replaces the common edge of two faces between the same objects.
 * - In the sides of a periodic box, either all images of an edge or vertex are edited, or none.
 */
class InterfaceEdits
{
public:
  /** Factor by which edges at junction points may temporarily exceed the maximum length. */
  static constexpr double CornerFactor = 4. / 3.;

  /**
   * @param clearance of the current mesh; not used by splits
   * @param shortest, longest as for InterfaceRemesher
   */
  InterfaceEdits(
    InterfaceMesh& mesh, InterfaceClearance& clearance, double shortest, double longest);

  /** Split the longest edge of an existing face if it is too long. */
  bool TrySplit(int face);
  /** Collapse the short edges of a face. @return number of collapses */
  int CollapseAt(int face);
  /** Flip at most one edge of an existing face. @return number of flips */
  int FlipAt(int face);
  /** Flip the longest edge of a triangle with a small angle, or collapse the shortest edge. */
  bool RemoveSliver(int face);

private:
  bool MayCollapse(int u, int v);
  /** Return whether all objects common to u and v are at AtEdge, so that none is pinched. */
  bool ShareObjects(int u, int v);
  /** Collapse an edge to its middle if both vertices have the same stratum, otherwise to an end. */
  bool TryCollapse(int u, int v);
  // The next three functions handle all Images of the edge.
  bool MayCollapseImages();
  bool AreFairCollapses(const Vector& position);
  void CollapseImages(const Vector& position);
  /** Return the position of the kept vertex of an image, given that of the first image. */
  Vector PositionOfImage(std::size_t image, const Vector& position) const;
  /** Test the quality of a collapse; append changed faces to Changed and new ones to Made. */
  bool IsFairCollapse(const Vector& position, int kept, int removed);
  bool MakesLongEdges(const Vector& position, int kept, int removed) const;
  void Collapse(const Vector& position, int kept, int removed);
  /** @param flatness least cosine of the angle between the normals of the faces */
  bool TryFlip(int u, int v, double flatness);
  /** Test the quality of a flip; append changed faces to Changed and new ones to Made. */
  bool IsFairFlip(int u, int v, double flatness);
  void Split(int u, int v);
  int SplitOne(int u, int v); ///< Split one image. @return the new vertex
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

  /** Least cosine of the angle by which an edit may turn a face. */
  static constexpr double LeastTurnCosine = 0.4;

  InterfaceMesh& Mesh;
  InterfaceClearance& Clearance;
  float Shortest; ///< squared length at size 1
  float Longest;  ///< squared length at size 1
  std::vector<int> AtEdge;
  std::vector<int> Changed;
  std::vector<std::array<int, 2>> Images; ///< images of the edge, the kept vertex first
  std::vector<int> Near;
  std::vector<int> First;
  std::vector<int> Second;
  std::vector<int> Common; ///< intersection of First and Second
  std::vector<FaceCoordinates> Made;
};
}

#endif
