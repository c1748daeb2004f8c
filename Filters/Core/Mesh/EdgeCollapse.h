// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeCollapse_h
#define volumicEdgeCollapse_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Contracts an edge (Kept, Removed); two faces go. chi stays. */
struct EdgeCollapse
{
  int Kept = -1;
  int Removed = -1;

  /**
   * Link condition: the ends have exactly the two opposite vertices in common, these have
   * valence over 3, and the new ring fits.
   */
  bool IsLegal(const SurfaceMesh& mesh) const;
  /** A third common neighbour, which makes a 3-cycle that bounds no face; -1 where none is. */
  int ThirdCommonNeighbour(const SurfaceMesh& mesh) const;
  /** The position of Kept is the caller's to set. */
  void Apply(SurfaceMesh& mesh, VertexRoom* room = nullptr) const;
};
}

#endif
