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
 * The merge (axial transformation): the stars of two vertices are removed and their rims joined
 * by a strip of triangles. chi - 2: two components become one, or one gains a handle.
 */
class StarMerge
{
public:
  int U = -1;
  int V = -1;

  /**
   * Plans the strip by dynamic programming over the start offsets: least sum of the squared lengths
   * of the bridge edges, which join the rims.
   * Paths that stay on one rim vertex for a whole turn are left out, they would double an edge.
   * @return false where the rims touch or are joined by an edge, or no strip fits the rings.
   */
  bool Plan(const SurfaceMesh& mesh);

  /** After Plan: the triangles of the strip, and the length of its longest bridge edge, squared. */
  const std::vector<std::array<int, 3>>& Strip() const { return this->Triangles; }
  float SquaredLongestBridgeEdge() const { return this->SquaredLongest; }

  void Apply(SurfaceMesh& mesh, VertexRoom* room = nullptr) const;

private:
  struct BridgeEdge
  {
    int First;  ///< Place on the rim of U, along its ring.
    int Second; ///< Place on the rim of V, against its ring.
  };
  /** False where the rims touch or an edge joins them. */
  bool MeasureLinks(const SurfaceMesh& mesh);
  void ChooseBridgeEdges();
  /** The best strip that begins at this place of the second rim. @return whether it is under best.
   */
  bool PlanFrom(int offset, float best, float& cost);
  /** A strip that goes about both rims at the same pace. @return its cost. */
  float PlanInStep(int offset);
  bool Fits(const SurfaceMesh& mesh) const;
  void MakeTriangles();
  void InsertBridgeEdges(SurfaceMesh& mesh, bool first) const;

  Ring FirstLink;
  Ring SecondLink;                               ///< Reversed.
  float Squared[Ring::Capacity][Ring::Capacity]; ///< Distances from rim to rim.
  std::vector<BridgeEdge> BridgeEdges;
  std::vector<BridgeEdge> Candidate;
  std::vector<std::array<int, 3>> Triangles;
  float SquaredLongest = 0;
};
}

#endif
