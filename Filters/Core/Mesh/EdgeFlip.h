// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeFlip_h
#define volumicEdgeFlip_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Flip of (U, V): the faces (U, V, A), (V, U, B) become (A, U, B), (B, V, A). chi stays. */
struct EdgeFlip
{
  int U = -1;
  int V = -1;
  int A = -1;
  int B = -1;

  /** Return the flip of an existing edge. It may be illegal. */
  static EdgeFlip Of(const SurfaceMesh& mesh, int u, int v);
  /** Return whether the result is a manifold with valences from 3 to Ring::Capacity. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  void Apply(SurfaceMesh& mesh) const;
};
}

#endif
