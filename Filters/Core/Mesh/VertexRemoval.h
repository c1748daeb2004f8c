// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexRemoval_h
#define volumicVertexRemoval_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Removal of a vertex of valence 3: its three faces become one. chi is unchanged. */
struct VertexRemoval
{
  int Vertex = -1;

  /** Return whether the valence is 3 and each neighbour keeps a valence of at least 3. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  void Apply(SurfaceMesh& mesh, VertexSlots* slots = nullptr) const;
};
}

#endif
