// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexRemoval_h
#define volumicVertexRemoval_h

#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Removes a vertex of valence 3; its three faces become one. chi stays. */
struct VertexRemoval
{
  int Vertex = -1;

  /** Whether the valence is 3 and the neighbours keep at least 3. */
  bool IsLegal(const SurfaceMesh& mesh) const;
  void Apply(SurfaceMesh& mesh, VertexRoom* room = nullptr) const;
};
}

#endif
