// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceBlocks_h
#define volumicSurfaceBlocks_h

#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * The vertices of a surface by cubes of space, the blocks, so that it can be worked on block by
 * block. The vertices of a block follow each other in memory (SurfaceMesh::Reorder along a curve
 * through the same cubes), and new ones take places that its own have left: what is far away is not
 * touched, and may be out of memory (ScratchMemory).
 *
 * Blocks are visited in the order of eight colours as far as neighbours are concerned (along each
 * axis those of even place before those of odd place), but slab by slab: 0, 2, 1, 4, 3, ... along
 * each axis. Blocks of one colour do not touch, so that the one order is as good as the other.
 */
class SurfaceBlocks
{
public:
  /** @param side of a block, workspace */
  SurfaceBlocks(SurfaceState& state, float side, Executor& executor);
  ~SurfaceBlocks();
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** In the order of their visits; some have no vertices. */
  const std::vector<int>& Order() const { return this->Visits; }

  /** Begins a visit. @return the vertices that lie in the block, in order of index. */
  const std::vector<int>& Open(int block);
  /** Of the vertices of a list, those that are new are the open block's from now on. */
  void AddNew(const std::vector<int>& vertices);
  /** Ends the visit: vertices that have left the block are others' from now on. */
  void Close();

  /** Asks for what most of a block's vertices know, before a visit. */
  void Prefetch(int block) const;

  /** Whether a vertex of the block may move. */
  bool HasActive(int block) const;


private:
  int BlockAt(const Vector& position) const;
  void Collect(Executor& executor);
  void FindOrder();

  SurfaceState& State;
  Vector Low;
  float Side;
  std::array<int, 3> Size = { 1, 1, 1 };
  std::vector<std::vector<int>> Vertices; ///< Of each block; some are others' by now, or no more.
  std::vector<VertexPlaces> Places;       ///< Of each block, for new vertices.
  std::size_t CommonPlaces = 0;           ///< Of the mesh, below those of the open block.
  std::vector<int> Visits;
  int Opened = NoBlock;
  std::ptrdiff_t OldOnes = 0; ///< Of its vertices, those that it had when it was opened: the first.
};
}

#endif
