// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeSplit_h
#define volumicEdgeSplit_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * Split of the edge (U, V). The new vertex is joined to the two opposite vertices. chi is
 * unchanged. At the midpoint the surface keeps its shape, so no intersection test is needed.
 */
struct EdgeSplit
{
  int U = -1;
  int V = -1;

  bool IsLegal(const SurfaceMesh& mesh) const;
  /** Return the new vertex. */
  int Apply(SurfaceMesh& mesh, const Vector& position, VertexSlots* slots = nullptr) const;
};
}

#endif
