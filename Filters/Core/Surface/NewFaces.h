// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicNewFaces_h
#define volumicNewFaces_h

#include "Core/Common/Executor.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/** Faces that an edit removes: those with any of some vertices, or with both of two. */
struct RemovedFaces
{
  std::array<int, 6> Vertex;
  int Count = 0;
  bool Both = false;

  bool Contains(const std::array<int, 3>& face) const
  {
    int found = 0;
    for (int i = 0; i < this->Count; ++i)
    {
      const int v = this->Vertex[i];
      found += face[0] == v || face[1] == v || face[2] == v;
    }
    return found > (this->Both ? 1 : 0);
  }
};

/**
 * Return whether any new face of an edit would intersect another new face, or a face of the mesh
 * that the edit does not remove. The mesh is not changed.
 */
bool NewFacesIntersect(
  const SurfaceState& state, const std::vector<MeshTriangle>& faces, const RemovedFaces& removed);

/**
 * Test all faces of the mesh, whatever their normals. Return the number of vertices that are the
 * smallest one of an intersecting face: 0 if and only if no faces intersect.
 */
std::size_t CountIntersecting(const SurfaceState& state, Executor& executor);
}

#endif
