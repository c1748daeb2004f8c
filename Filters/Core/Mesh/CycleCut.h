// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCycleCut_h
#define volumicCycleCut_h

#include "Core/Mesh/SurfaceMesh.h"

#include <array>

namespace volumic
{
/**
 * Cut along a 3-cycle that bounds no face (annular transformation). Both sides are closed with a
 * triangle. chi increases by 2: a component splits, or loses a handle. The old vertices keep the
 * faces to the left of A -> B -> C -> A, their copies get those to the right. Originals and copies
 * coincide until the caller moves them apart.
 */
struct CycleCut
{
  int A = -1;
  int B = -1;
  int C = -1;

  /** Return whether the vertices are pairwise neighbours and neither triangle is a face. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  /** Return the copies of A, B and C. The caps are (A, C, B) and (A', B', C'). */
  std::array<int, 3> Apply(SurfaceMesh& mesh, VertexSlots* slots = nullptr) const;
};
}

#endif
