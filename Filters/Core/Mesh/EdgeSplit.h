// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeSplit_h
#define volumicEdgeSplit_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * Sets a vertex into an edge (U, V) and joins it to the two opposite vertices. chi stays.
 * At the midpoint the surface as a set of points is unchanged, so nothing needs verification.
 */
struct EdgeSplit
{
  int U = -1;
  int V = -1;

  bool IsLegal(const SurfaceMesh& mesh) const;
  /** @return the new vertex. */
  int Apply(SurfaceMesh& mesh, const Vector& position, VertexRoom* room = nullptr) const;
};
}

#endif
