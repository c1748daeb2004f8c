// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeCollapse_h
#define volumicEdgeCollapse_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Collapse of the edge (Kept, Removed). Two faces are removed, chi is unchanged. */
struct EdgeCollapse
{
  int Kept = -1;
  int Removed = -1;

  /**
   * Return whether the link condition holds: the ends have exactly the two opposite vertices in
   * common. These must have a valence over 3, and the new ring must fit Ring::Capacity.
   */
  bool IsLegal(const SurfaceMesh& mesh) const;
  /**
   * Return the nearest third common neighbour of the ends (a 3-cycle that bounds no face), or -1.
   */
  int ThirdCommonNeighbour(const SurfaceMesh& mesh) const;
  /** Apply the collapse. The caller sets the position of Kept. */
  void Apply(SurfaceMesh& mesh, VertexSlots* slots = nullptr) const;
};
}

#endif
