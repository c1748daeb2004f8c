// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCycleCut_h
#define volumicCycleCut_h

#include "Core/Mesh/SurfaceMesh.h"

#include <array>

namespace volumic
{
/**
 * The cut (annular transformation): the mesh is cut along a 3-cycle that bounds no face and both
 * sides are closed with a triangle. chi + 2: a component splits, or loses a handle.
 *
 * The old vertices keep the faces to the left of A -> B -> C -> A, new ones take those to the
 * right. Both lie at the same place until the caller moves them apart.
 */
struct CycleCut
{
  int A = -1;
  int B = -1;
  int C = -1;

  /** Whether the three are pairwise neighbours and neither of the two triangles is a face. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  /** @return the copies of A, B and C; the caps are (A, C, B) and (A', B', C'). */
  std::array<int, 3> Apply(SurfaceMesh& mesh, VertexRoom* room = nullptr) const;
};
}

#endif
