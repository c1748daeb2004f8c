// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceBlocks_h
#define volumicSurfaceBlocks_h

#include "Core/Common/Box.h"
#include "Core/Common/VisitSchedule.h"
#include "Core/Surface/SurfaceEditor.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <cstdint>
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
struct BlockVisit
{
  int Block = NoBlock;
  std::vector<int> Vertices; ///< That lie in the block, by index; then those that the visit made.
  Box Moving;                ///< Vertices that lie in it may move; EditShare::Region is for edits.
  Box Written;               ///< Beyond it nothing is changed.
  EditShare Share;
  /** Threads that may share in loops that write to their own vertex only, and read nothing such. */
  Executor* Idle = &OnThisThread();
  std::ptrdiff_t OldOnes = 0; ///< So many of the vertices were there when the visit was opened.
  int PlacesBefore = 0;       ///< The share had so many places then.
};

/**
 * The vertices of a surface by cubes of space, the blocks, so that it can be worked on block by
 * block. The vertices of a block follow each other in memory (SurfaceMesh::Reorder along a curve
 * through the same cubes), and each block has places of its own for new ones: what is far away is
 * not touched, and may be out of memory (ScratchMemory).
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
  ~SurfaceBlocks();
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** The order of their visits, and what waits for what; some have no vertices. */
  const VisitSchedule& Schedule() const { return *this->Visits; }
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
  BlockVisit Open(int block);
  /** Gives the open block those vertices of a list that are new. */
  void AddNew(BlockVisit& visit, const std::vector<int>& vertices) const;
  /**
   * Ends it, on the thread that made it: vertices that have left the block are others' from now on,
   * and the state's number of vertices and chi are those after the visit.
   */
  void Close(BlockVisit&& visit);

  /** Before a visit: has the memory fetch most of what the block's vertices know. */
  void Prefetch(int block) const;

  /** Whether a vertex of the block may move. */
  bool HasActive(int block) const;
  /** How many places each block would like to have for new vertices, beyond those that it has. */
  std::vector<int> MissingPlaces(Executor& executor) const;
  /** Gives each block so many more. Between sweeps, while no visit is open. */
  void AddPlaces(const std::vector<int>& counts, Executor& executor);
  /**
   * Adds a closed surface, whose vertices follow all others, and gives them to their blocks. Between
   * sweeps, while none is open.
   */
  void Append(const IndexedSurface& surface, Executor& executor);

  int BlockAt(const Vector& position) const;
  /** The box that a block fills; at the border of the frame it goes on without end. */
  Box BoxOf(int block) const;
  /** Its place in the frame, along each axis. */
  std::array<int, 3> PlaceOf(int block) const;
  /** Those that touch it, in order of their number. */
  std::vector<int> NeighboursOf(int block) const;
  /** The vertices that are the block's now, each once, in order. */
  std::vector<int> VerticesOf(int block) const;
  const Frame& GetFrame() const { return this->TheFrame; }

  /** The sum of ofVertex(v) over the vertices of a block, in order of index, then over the blocks. */
  double SumUp(const std::function<double(int v)>& ofVertex, Executor& executor) const;

private:
  struct OfBlock
  {
    std::vector<int> Vertices; ///< Some may be others' by now, or be removed.
    VertexPlaces Places;       ///< For new vertices.
    UnusedPlaces Unused;
    int Taken = 0; ///< Its last visit has taken so many of the places.
  };
  std::array<int, 3> PlaceOf(const Vector& position) const;
  int BlockOf(const std::array<int, 3>& place) const;
  /** Leaves of a list those that are the block's, each once, in order. */
  void Clean(int block, std::vector<int>& vertices) const;
  int MissingPlacesOf(int block) const;
  void Collect(Executor& executor);
  void FindOrder();

  SurfaceState& State;
  Frame TheFrame;
  std::vector<OfBlock> All;
  VertexPlaces Others; ///< Places that were free before there were blocks: no block takes them.
  std::unique_ptr<VisitSchedule> Visits;
  mutable std::mutex Closing; ///< Held while a visit changes what all visits share.
};
}

#endif
