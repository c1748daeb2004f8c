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
 * by a band of triangles. chi - 2: two components become one, or one gains a handle.
 */
class StarMerge
{
public:
  int U = -1;
  int V = -1;

  /**
   * Plans the band by dynamic programming over the start offsets: least sum of squared rungs.
   * Paths that stay on one rim vertex for a whole turn are left out, they would double an edge.
   * @return false where the rims touch or are joined by an edge, or no band fits the rings.
   */
  bool Plan(const SurfaceMesh& mesh);

  /** After Plan: the triangles of the band, and its longest rung, squared. */
  const std::vector<std::array<int, 3>>& Strip() const { return this->Triangles; }
  float SquaredLongestBridgeEdge() const { return this->Longest; }

  void Apply(SurfaceMesh& mesh) const;

private:
  struct Rung
  {
    int First;  ///< Place on the rim of U, along its ring.
    int Second; ///< Place on the rim of V, against its ring.
  };
  bool PlanFrom(int offset, float best, float& cost);
  bool Fits(const SurfaceMesh& mesh) const;
  void InsertRungs(SurfaceMesh& mesh, bool first) const;

  Ring FirstRim;
  Ring SecondRim; ///< Reversed.
  float Squared[Ring::Capacity][Ring::Capacity];
  std::vector<Rung> Rungs;
  std::vector<Rung> Candidate;
  std::vector<std::array<int, 3>> Triangles;
  float Longest = 0;
};
}

#endif
