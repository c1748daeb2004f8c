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
 * Pass over a block while it is open: the part of the surface that it may change, and its own data.
 * Passes over blocks that do not touch can run concurrently.
 */
struct BlockPass
{
  int Block = 0;
  int First = 0; ///< Its vertices are in [First, End()): those of the block, then new ones.
  Box Moving;    ///< Only vertices in it may move. EditContext::Region limits edits.
  Box Written;   ///< Nothing is changed outside.
  EditContext Context;
  LargeComponents Large; ///< At the start of the pass.

  /** The range may contain free slots. */
  int End() const { return this->Context.Slots.Next; }
};

/**
 * Vertices of a surface partitioned into cubic blocks, which are processed one by one. The vertices
 * of a block are a range of indices followed by free slots. A pass therefore accesses a range of
 * each array, and the rest can be out of memory (ScratchMemory). Vertices are renumbered only
 * between sweeps, if one has left its block or few slots are free.
 *
 * The result of a pass depends only on the vertices in and about the block at its start. Therefore
 * blocks that do not touch may be processed concurrently. Blocks that touch are processed in the
 * order of eight colours: along each axis even indices before odd ones. This holds for any number
 * of iterations per pass:
 * - A vertex moves only within MovingInDelta of the block, and edits begin at stars within
 *   EditedInDelta. Others are left to the neighbour's pass.
 * - An edge is at most 4.5 delta long. From HugeEdge times the longest legal edge on, 3.5 delta,
 *   its ends do not move until it is split. They may have moved in one iteration before.
 * - Positions, rings and shapes are therefore written within WrittenInDelta: the region of edits
 *   plus an edge length.
 * - Vertices are tested if they, or a neighbour, have moved or were edited: within 7.5 delta. The
 *   search radius is 2.05 delta, and stars found are read: within HaloInDelta.
 * - The side of a block, SideInDelta, is the sum of what is written, what is read and one cell of
 *   the grid.
 */
class SurfaceBlocks
{
public:
  /** Position and size of the blocks. The outermost are unbounded. */
  struct Frame
  {
    Vector Low; ///< Corner of the first block, if it were bounded.
    std::array<float, 3> Side = { 1.f, 1.f, 1.f }; ///< Side of a block, in the computational space.
    std::array<int, 3> Size = { 1, 1, 1 };
  };
  /**
   * Return the frame for an image of this extent in the computational space, with one corner at the
   * origin. The outermost blocks share the remainder of the division into whole blocks. An axis
   * shorter than two blocks has one.
   */
  static Frame FrameOf(const std::array<double, 3>& extent, double side);

  // In delta.
  static constexpr float MovingInDelta = 2.5f;
  static constexpr float EditedInDelta = 3.f;
  static constexpr float WrittenInDelta = 7.5f;
  static constexpr float HaloInDelta = 14.2f;
  static constexpr float SideInDelta = 24.f;

  SurfaceBlocks(SurfaceState& state, const Frame& frame, Executor& executor);
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** Return the order of the passes and their dependencies. Some blocks have no vertices. */
  const BlockSchedule& Schedule() const { return *this->Passes; }
  int NumberOfBlocks() const { return static_cast<int>(this->Ranges.size()); }
  /** Return the number of vertices. Changes of open passes count from Close() on. Thread-safe. */
  int NumberOfVertices() const
  {
    const std::lock_guard<std::mutex> lock(this->Closing);
    return this->State.Mesh.NumberOfVertices();
  }

  /**
   * Begin a pass. Thread-safe while no adjacent block is open. Until Close() the pass has exclusive
   * access to the vertices of the block and those about it.
   */
  BlockPass Open(int block);
  /** End a pass, on its thread. Its counts are added to those of the state. */
  void Close(BlockPass&& pass);

  /** Return whether a vertex of the block may move. */
  bool HasActive(int block) const;
  /** Renumber the vertices if necessary. Call it between sweeps, with no pass open. */
  void Prepare(Executor& executor);
  /**
   * Add a closed surface unless it intersects something. Call it between sweeps, with no pass open.
   * @param isInParts leave out only the components that intersect something
   * @return whether the whole surface was added
   */
  bool Append(const IndexedSurface& surface, bool isInParts, Executor& executor);

  int BlockAt(const Vector& position) const;
  /** Return the box of a block, unbounded at the border of the frame. */
  Box BoxOf(int block) const;
  /** Return the indices of a block along the axes. */
  std::array<int, 3> IjkOf(int block) const;
  /** Return the adjacent blocks, in ascending order. */
  std::vector<int> NeighboursOf(int block) const;
  const Frame& GetFrame() const { return this->TheFrame; }

  /**
   * Return the sum of ofVertex(v) over the vertices of each block, in order, then over the blocks.
   * ofVertex() must return 0 for free slots.
   */
  double SumUp(const std::function<double(int v)>& ofVertex, Executor& executor) const;

private:
  struct VertexRange
  {
    int First = 0; ///< Vertices: [First, Next).
    int Next = 0;  ///< Free slots: [Next, End).
    int End = 0;
    int SlotsUsed = 0;     ///< Slots used by its last pass.
    bool HasStray = false; ///< A vertex has left the block.
  };
  std::array<int, 3> IjkOf(const Vector& position) const;
  int BlockOf(const std::array<int, 3>& ijk) const;
  void Reorder(Executor& executor, bool isNew);
  void MakeSchedule();

  SurfaceState& State;
  Frame TheFrame;
  std::vector<VertexRange> Ranges;
  ReorderBuffers Buffers;
  std::unique_ptr<BlockSchedule> Passes;
  mutable std::mutex Closing; ///< Guards what all passes share.
};
}

#endif
