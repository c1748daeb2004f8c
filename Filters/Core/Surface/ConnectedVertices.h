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
 * Vertices with a mark. Where the others take no memory (MakeZeroed) it stays so: what is told of a
 * part says nothing of others.
 */
struct MarkedVertices
{
  const LargeVector<std::uint8_t>& Marks; ///< By vertex; 0 where there is none.
  std::uint8_t Mark;
  bool Has(int v) const { return this->Marks[v] == this->Mark; }
};

/**
 * The sets of vertices that edges join: the components of a surface, or, of a part of it, what of
 * them the part has. The same for any executor; O(vertices).
 */
class ConnectedVertices
{
public:
  /** In the place of a label: where there is no vertex. */
  static constexpr int None = -1;

  /**
   * Labels the sets of a whole surface, from 0, in the order of their smallest vertices.
   * @param labels by vertex, as many as there are; None where there is none
   */
  void Label(const SurfaceMesh& mesh, LargeVector<int>& labels, Executor& executor);
  /** The same for some alive vertices and the edges between them; the others' labels stay. */
  void Label(const SurfaceMesh& mesh, const MarkedVertices& part, LargeVector<int>& labels,
    Executor& executor);

  /** By label: its smallest vertex. */
  const std::vector<int>& Roots() const { return this->SmallestOnes; }
  /** By label: how many vertices it has. */
  const std::vector<int>& Sizes() const { return this->Numbers; }

private:
  template <typename Part>
  void LabelPart(const SurfaceMesh& mesh, const Part& part, LargeVector<int>& labels,
    Executor& executor);
  template <typename Part>
  void JoinVertices(const SurfaceMesh& mesh, const Part& part, Executor& executor);
  template <typename Part>
  void CountAndLabel(const Part& part, LargeVector<int>& labels, std::size_t n, Executor& executor);

  DisjointSets Joined;
  std::vector<std::vector<std::pair<int, int>>> Borders; ///< Edges from each block to those before.
  std::vector<int> SmallestOnes;
  std::vector<int> Numbers;
};
}

#endif
