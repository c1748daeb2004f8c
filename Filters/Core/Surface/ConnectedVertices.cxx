// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ConnectedVertices.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Select.h"

#include <cstddef>

namespace volumic
{
namespace
{
/** Vertices that one thread joins at a time. */
constexpr std::size_t JoinedSpan = 4096;

void JoinNeighbours(const SurfaceMesh& mesh, DisjointSets& joined, Executor& executor)
{
  ForSpans(executor, mesh.Rings.size(), JoinedSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        // Neighbours next to each other are neighbours themselves: of the smaller ones that follow
        // each other one is enough.
        const Ring& ring = mesh.Rings[v];
        bool wasSmaller = false;
        for (int i = 0; i < ring.Count; ++i)
        {
          const bool isSmaller = ring.Item[i] < v;
          if (isSmaller && !wasSmaller)
          {
            joined.Join(v, ring.Item[i]);
          }
          wasSmaller = isSmaller;
        }
      }
    });
}
}

void ConnectedVertices::Label(const SurfaceMesh& mesh, LargeVector<int>& labels, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  DisjointSets joined(n);
  JoinNeighbours(mesh, joined, executor);
  this->SmallestOnes = SelectIndices(executor, n,
    [&](std::size_t i)
    {
      const int v = static_cast<int>(i);
      return mesh.IsAlive(v) && joined.Find(v) == v;
    });
  for (std::size_t label = 0; label < this->SmallestOnes.size(); ++label)
  {
    labels[this->SmallestOnes[label]] = static_cast<int>(label);
  }
  ForSpans(executor, n, JoinedSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        const int root = mesh.IsAlive(v) ? joined.Find(v) : v;
        if (v != root) // Others read the root's.
        {
          labels[v] = labels[root];
        }
      }
    });
}
}
