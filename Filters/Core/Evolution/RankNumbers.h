// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankNumbers_h
#define volumicRankNumbers_h

#include "Core/Common/Communicator.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * How many points of the whole come before a vertex, and how many triangles, or what else is
 * counted, before those that it is the smallest of.
 */
struct VertexNumber
{
  int Point = 0;
  int Face = 0;
};

/** Numbers of vertices that this rank knows of. */
struct VertexNumbers
{
  LargeVector<VertexNumber> Of; ///< By vertex; takes no memory where it says nothing.
  VertexNumber All;             ///< How many the whole has.
};

/** Tells how many triangles a vertex is the smallest of. */
inline std::function<int(int v)> FacesOf(const SurfaceMesh& mesh)
{
  return [&mesh](int v)
  {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<int>(mesh.CountFaces(i, i + 1));
  };
}

/**
 * By all ranks that have a surface in pieces: numbers its vertices and triangles as one rank would
 * have them, by their indices. Each rank counts a stretch of the indices for all.
 * @param places how many indices there are, of vertices or not
 * @param facesOf of own vertices, see FacesOf()
 * @param own vertices of this rank
 * @param others vertices of other ranks whose numbers are wanted, too
 */
VertexNumbers NumberOnRanks(Communicator& ranks, std::size_t places,
  const std::function<int(int v)>& facesOf, const std::vector<int>& own, const std::vector<int>& others);
}

#endif
