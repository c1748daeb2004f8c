// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarMerge_h
#define volumicStarMerge_h

#include "Core/Mesh/SurfaceMesh.h"

#include <array>
#include <vector>

namespace volumic
{
/**
 * Merge of two vertices (axial transformation). Their stars are removed and the links are joined by
 * a strip of triangles. chi decreases by 2: two components become one, or one gains a handle.
 */
class StarMerge
{
public:
  int U = -1;
  int V = -1;

  /**
   * Plan the strip: minimise the sum of the squared lengths of the bridge edges, which join the
   * links, by dynamic programming over all start offsets. Paths that stay on one link vertex for a
   * whole turn are excluded, as they would duplicate an edge.
   * @return false if the links touch or are joined by an edge, or if no strip fits the rings
   */
  bool Plan(const SurfaceMesh& mesh);

  /** Return the triangles of the strip. Valid after Plan(). */
  const std::vector<std::array<int, 3>>& Strip() const { return this->Triangles; }
  float SquaredLongestBridgeEdge() const { return this->SquaredLongest; }

  void Apply(SurfaceMesh& mesh, VertexSlots* slots = nullptr) const;

private:
  struct BridgeEdge
  {
    int First;  ///< Index in the link of U, in the order of its ring.
    int Second; ///< Index in the link of V, in reverse order of its ring.
  };
  /** Return false if the links touch or an edge joins them. */
  bool MeasureLinks(const SurfaceMesh& mesh);
  void ChooseBridgeEdges();
  /** Find the best strip from `offset` of the second link. Return whether its cost is < best. */
  bool PlanFrom(int offset, float best, float& cost);
  /** Make a strip that advances evenly along both links. Return its cost. */
  float PlanInStep(int offset);
  bool Fits(const SurfaceMesh& mesh) const;
  void MakeTriangles();
  void InsertBridgeEdges(SurfaceMesh& mesh, bool first) const;

  Ring FirstLink;
  Ring SecondLink;                               ///< Reversed.
  float Squared[Ring::Capacity][Ring::Capacity]; ///< Distances between the links.
  std::vector<BridgeEdge> BridgeEdges;
  std::vector<BridgeEdge> Candidate;
  std::vector<std::array<int, 3>> Triangles;
  float SquaredLongest = 0;
};
}

#endif
