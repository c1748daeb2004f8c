// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceClearance_h
#define volumicInterfaceClearance_h

#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Mesh/VertexGrid.h"

#include <array>
#include <vector>

namespace volumic
{
/** Corners of a triangle that there is not yet, and the vertices that they are. */
MeshTriangle TriangleOf(const InterfaceMesh& mesh, const std::array<int, 3>& vertices);

/** A face that there is, or may be. */
struct PlacedFace : MeshTriangle
{
  LabelMap::Number Behind;
  LabelMap::Number Front;
};
PlacedFace PlacedFaceOf(const InterfaceMesh& mesh, const InterfaceMesh::Face& face);

/**
 * Whether faces that share an edge are about it in the order that their objects want: what one has
 * on its one side the next one has on that side, too. Where one has been turned past another,
 * objects overlap, though nothing intersects.
 */
bool AreInOrder(int u, int v, const std::vector<PlacedFace>& faces);

/** Which triangles of interfaces are near others, and whether they intersect them. */
class InterfaceClearance
{
public:
  /**
   * @param mesh must outlive it
   * @param tolerance triangles nearer than that count as intersecting
   */
  InterfaceClearance(const InterfaceMesh& mesh, double tolerance);

  /** Lays its grid afresh. @param longest of the edges, about */
  void Reset(double longest);
  void Remove(int v) { this->Grid.Remove(v); }
  void Move(int v) { this->Grid.Move(v, this->Mesh.Position[static_cast<std::size_t>(v)]); }
  /** To be called of each face that is new, or has another corner, or a corner elsewhere. */
  void Change(int face);

  /** What one thread remembers while it looks at faces. */
  struct Memory
  {
    std::vector<int> Seen; ///< of each face, when
    int Now = 0;
    std::vector<int> Near; ///< what was found last
  };
  /** Faces from `first` on that may come near a box, in Memory::Near. */
  void FindNear(const Vector& low, const Vector& high, int first, Memory& memory) const;
  /** A face that this one intersects, of those from `first` on; -1: none. */
  int FindIntersecting(int face, int first, Memory& memory) const;
  /**
   * Whether faces may take the place of some: they intersect nothing else, nor each other, and are
   * in order at junction lines.
   */
  bool AreClear(const std::vector<PlacedFace>& faces, const std::vector<int>& replaced,
    Memory& memory) const;

private:
  /** Whether one of its edges may be of a junction line. */
  bool IsAtLine(const PlacedFace& face) const;
  /** @param others faces that stay, among them all that share an edge with these */
  bool AreInOrderAtLines(
    const std::vector<PlacedFace>& faces, const std::vector<int>& others) const;
  void Insert(int v) { this->Grid.Insert(v, this->Mesh.Position[static_cast<std::size_t>(v)]); }

  const InterfaceMesh& Mesh;
  double Tolerance;
  float LongestReach = 0.f;
  std::vector<float> Reach; ///< of each vertex, how far a face goes at most of which it is nearest
  VertexGrid Grid;
};
}

#endif
