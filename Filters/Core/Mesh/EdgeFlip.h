// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeFlip_h
#define volumicEdgeFlip_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * Replaces an edge (U, V) by the one that joins the vertices A, B opposite to it: faces (U, V, A)
 * and (V, U, B) become (A, U, B) and (B, V, A). chi stays.
 */
struct EdgeFlip
{
  int U = -1;
  int V = -1;
  int A = -1;
  int B = -1;

  /** The flip of an existing edge; no check. */
  static EdgeFlip Of(const SurfaceMesh& mesh, int u, int v);
  /** Whether the result is a manifold of valences from 3 to Ring::Capacity. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  void Apply(SurfaceMesh& mesh) const;
};
}

#endif
