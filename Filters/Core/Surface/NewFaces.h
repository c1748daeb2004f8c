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
/** The faces that an edit removes: those with any of some vertices, or those with both of two. */
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
 * Whether any of the new faces of an edit would intersect another of them, or a face of the mesh
 * that the edit does not remove. Nothing is changed.
 */
bool NewFacesIntersect(
  const SurfaceState& state, const std::vector<MeshTriangle>& faces, const RemovedFaces& removed);

/**
 * The same for the faces of the mesh as it is, whatever their normals are. @return the number of
 * vertices that are the first, by index, of a face that intersects another one: 0 if and only if
 * nothing intersects.
 */
std::size_t CountIntersecting(const SurfaceState& state, Executor& executor);
}

#endif
