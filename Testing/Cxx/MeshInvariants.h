// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMeshInvariants_h
#define volumicMeshInvariants_h

#include "Core/Mesh/SurfaceMesh.h"
#include "TestPrelude.h"

namespace volumic
{
/**
 * Test the invariants of a mesh: consistent rings, no duplicate neighbours, both orientations of
 * each edge, finite positions, free list. @return description of the first fault, empty if valid
 */
inline std::string DescribeBrokenInvariant(const SurfaceMesh& mesh)
{
  int alive = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    const std::string name = "vertex " + std::to_string(v);
    if (ring.Count == 0)
    {
      continue;
    }
    ++alive;
    if (ring.Count < 3 || ring.Count > Ring::Capacity)
    {
      return name + " has " + std::to_string(ring.Count) + " neighbours";
    }
    const Vector& p = mesh.Position[v];
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(p.Z))
    {
      return name + " has a position that is not finite";
    }
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      if (w < 0 || w >= mesh.Size() || w == v || !mesh.IsAlive(w))
      {
        return name + " has the neighbour " + std::to_string(w) + ", which is none";
      }
      for (int j = i + 1; j < ring.Count; ++j)
      {
        if (ring.Item[j] == w)
        {
          return name + " has the neighbour " + std::to_string(w) + " twice";
        }
      }
      // The face (v, w, next) must be (w, next, v) in the ring of w.
      const Ring& other = mesh.Rings[w];
      const int at = other.Find(ring.Next(i));
      if (at < 0 || other.Next(at) != v)
      {
        return name + " and " + std::to_string(w) + " disagree about their common face";
      }
    }
  }
  if (alive != mesh.NumberOfVertices())
  {
    return "the free list does not fit: " + std::to_string(alive) + " alive, " +
      std::to_string(mesh.NumberOfVertices()) + " expected";
  }
  return {};
}
}

#endif
