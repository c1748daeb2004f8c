// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicConnectedVertices_h
#define volumicConnectedVertices_h

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
/**
 * The vertices that have a mark. Nothing is written for others, so that the zeroed memory of places
 * that no vertex has (MakeZeroed) stays untouched and takes no room.
 */
struct MarkedVertices
{
  const LargeVector<std::uint8_t>& Marks; ///< By vertex; 0 where there is none.
  std::uint8_t Mark;
  bool Has(int v) const { return this->Marks[v] == this->Mark; }
};

/**
 * The sets of vertices that edges join: the components of a surface, or, of a piece of it, what of
 * them the piece has. The same for any executor; O(vertices).
 */
class ConnectedVertices
{
public:
  /**
   * Labels, from 0, in the order of their smallest vertices, the sets of some alive vertices and the
   * edges between them.
   * @param labels by vertex; those of others stay
   */
  void Label(const SurfaceMesh& mesh, const MarkedVertices& piece, LargeVector<int>& labels,
    Executor& executor);

  /** By label: its smallest vertex. */
  const std::vector<int>& Roots() const { return this->SmallestOnes; }
  /** By label: how many vertices it has. */
  const std::vector<int>& Sizes() const { return this->Numbers; }

private:
  void JoinVertices(const SurfaceMesh& mesh, const MarkedVertices& piece, Executor& executor);
  void CountAndLabel(
    const MarkedVertices& piece, LargeVector<int>& labels, std::size_t n, Executor& executor);

  DisjointSets Joined;
  std::vector<std::vector<std::pair<int, int>>> Borders; ///< Edges from each span to those before.
  std::vector<int> SmallestOnes;
  std::vector<int> Numbers;
};
}

#endif
