// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceBlocks_h
#define volumicSurfaceBlocks_h

#include "Core/Common/BlockSchedule.h"
#include "Core/Common/Box.h"
#include "Core/Surface/ComponentWatch.h"
#include "Core/Surface/SurfaceEditor.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace volumic
{
/**
 * A visit of a block, while it is open: what of the surface it may change, and what it keeps for
 * itself so that visits of blocks that do not touch can be made at the same time.
 */
struct BlockPass
{
  int Block = 0;
  int First = 0; ///< Its vertices are those of [First, End()): the block's, then those it has made.
  Box Moving;    ///< Vertices that lie in it may move; EditContext::Region is for edits.
  Box Written;   ///< Beyond it nothing is changed.
  EditContext Share;
  LargeComponents Large; ///< At its begin.

  /** Some places of the range may be without a vertex. */
  int End() const { return this->Share.Room.Next; }
};

/**
 * The vertices of a surface by cubes of space, the blocks, so that it can be worked on block by
 * block. The vertices of a block are a range of indices, with some room at its end for new ones, so
 * that a visit touches a range of each array, and the rest may be out of memory (ScratchMemory).
 * Between sweeps, where one has left its block or there is little room, all are numbered anew; in
 * between a vertex stays with its block wherever it goes.
 *
 * What a visit does depends on the vertices in the block and about it only, as they are then, and
 * not on what is done elsewhere meanwhile. So blocks that do not touch may be visited in any order,
 * or at the same time; those that touch are visited in the order of eight colours (along each axis
 * those of even place before those of odd place). That holds however many iterations a visit makes:
 *
 * - a vertex moves only while it lies within MovingInDelta of the block, and edits begin at stars
 *   within EditedInDelta; what is refused for that is left for the neighbour's visit;
 * - an edge is at most 4.5 delta long: from HugeEdge times the longest legal one on, which is 3.5
 *   delta, its ends keep still until it is split; they may have moved by an iteration before;
 * - so positions, rings and shapes are written within WrittenInDelta of the block, which is the
 *   region of edits and the length of an edge beyond it;
 * - vertices are examined which have moved, were edited, or are neighbours of such ones: these lie
 *   within 7.5 delta. Each looks for others within its reach of 2.05 delta, and reads their stars:
 *   so all that is read lies within HaloInDelta.
 * Blocks are as wide as what is written and what is read, and a cell of the grid: SideInDelta.
 */
class SurfaceBlocks
{
public:
  /** Where the blocks lie; the outermost go on without end. */
  struct Frame
  {
    Vector Low; ///< The first one would begin here if it were as wide as the others.
    std::array<float, 3> Side = { 1.f, 1.f, 1.f }; ///< Of a block, workspace.
    std::array<int, 3> Size = { 1, 1, 1 };
  };
  /**
   * The frame for an image of this extent, in the workspace, with one corner at the origin. Along
   * each axis the outermost blocks share what whole ones leave; an axis that is shorter than two of
   * them has one block.
   */
  static Frame FrameOf(const std::array<double, 3>& extent, double side);

  // All in delta.
  static constexpr float MovingInDelta = 2.5f;
  static constexpr float EditedInDelta = 3.f;
  static constexpr float WrittenInDelta = 7.5f;
  static constexpr float HaloInDelta = 14.2f;
  static constexpr float SideInDelta = 24.f;

  SurfaceBlocks(SurfaceState& state, const Frame& frame, Executor& executor);
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** The order of their visits, and what waits for what; some have no vertices. */
  const BlockSchedule& Schedule() const { return *this->Passes; }
  int NumberOfBlocks() const { return static_cast<int>(this->All.size()); }
  /** Those of the surface; what open visits add or remove counts when these end. On any thread. */
  int NumberOfVertices() const
  {
    const std::lock_guard<std::mutex> lock(this->Closing);
    return this->State.Mesh.NumberOfVertices();
  }

  /**
   * Begins a visit. On any thread, while no block is open that touches this one. Until Close() the
   * block's vertices, and what lies about them, are the visit's alone.
   */
  BlockPass Open(int block);
  /**
   * Ends it, on the thread that made it: the state's number of vertices and chi are those after the
   * visit.
   */
  void Close(BlockPass&& visit);

  /** Whether a vertex of the block may move. */
  bool HasActive(int block) const;
  /** Between sweeps, while no visit is open: numbers the vertices anew where that is needed. */
  void Prepare(Executor& executor);
  /**
   * Adds a closed surface, and gives its vertices to their blocks, unless it intersects something.
   * Between sweeps, while no visit is open.
   * @param isInParts then only the components that intersect something are left out
   * @return whether all of it was added
   */
  bool Append(const IndexedSurface& surface, bool isInParts, Executor& executor);

  int BlockAt(const Vector& position) const;
  /** The box that a block fills; at the border of the frame it goes on without end. */
  Box BoxOf(int block) const;
  /** Its place in the frame, along each axis. */
  std::array<int, 3> IjkOf(int block) const;
  /** Those that touch it, in order of their number. */
  std::vector<int> NeighboursOf(int block) const;
  const Frame& GetFrame() const { return this->TheFrame; }

  /**
   * The sum of ofVertex(v) over the vertices of a block, in order of index, then over the blocks.
   * It is 0 where there is no vertex.
   */
  double SumUp(const std::function<double(int v)>& ofVertex, Executor& executor) const;

private:
  struct OfBlock
  {
    int First = 0;         ///< Its vertices are those of [First, Next), and
    int Next = 0;          ///< its room for new ones is the rest of
    int End = 0;           ///< [First, End).
    int Taken = 0;         ///< Its last visit has made so many.
    bool IsAstray = false; ///< A vertex has left it.
  };
  std::array<int, 3> IjkOf(const Vector& position) const;
  int BlockOf(const std::array<int, 3>& place) const;
  void Reorder(Executor& executor, bool isNew);
  void FindOrder();

  SurfaceState& State;
  Frame TheFrame;
  std::vector<OfBlock> All;
  VertexSpares Spares; ///< See SurfaceMesh::Reorder.
  std::unique_ptr<BlockSchedule> Passes;
  mutable std::mutex Closing; ///< Held while a visit changes what all visits share.
};
}

#endif
