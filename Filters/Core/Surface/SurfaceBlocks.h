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
  /** Threads that may share in what writes to its own vertex only, and reads nothing written so. */
  Executor* Idle = &OnThisThread();

  std::ptrdiff_t OldOnes = 0; ///< Of the vertices, those that there were when it was opened.
  int PlacesBefore = 0;       ///< As many as the share had then.
};

/**
 * The vertices of a surface by cubes of space, the blocks, so that it can be worked on block by
 * block. The vertices of a block follow each other in memory (SurfaceMesh::Reorder along a curve
 * through the same cubes), and each block has places of its own for new ones: what is far away is
 * not touched, and may be out of memory (ScratchMemory) or on another rank (RankBlocks).
 *
 * What a visit does depends on the vertices in the block and about it only, as they are then, and
 * not on what is done elsewhere meanwhile. So blocks that do not touch may be visited in any order,
 * or at the same time; those that touch are visited in the order of eight colours (along each axis
 * those of even place before those of odd place). That holds however many iterations a visit makes:
 *
 * - a vertex moves only while it lies within MovingInDelta of the block, and edits begin at stars
 *   within EditedInDelta; what is refused for that is left for the neighbour's visit;
 * - an edge is at most 4.5 delta long: HugeEdge times the longest legal one, 3.5 delta, and what
 *   both ends move in an iteration, after which they keep still until it is split;
 * - so positions, rings and shapes are written within WrittenInDelta of the block: an edit's region
 *   and an edge;
 * - what is examined moved, was edited, or is a neighbour of what did or was (7.5 delta); it looks
 *   for vertices within the reach of 2.05 delta, and reads their stars: all within HaloInDelta.
 * Blocks are as wide as both together and a cell of the grid: SideInDelta.
 */
class SurfaceBlocks
{
public:
  /** Where the blocks lie; the outermost go on without end. */
  struct Frame
  {
    Vector Low; ///< Where the first one would begin were it as wide as the others.
    std::array<float, 3> Side = { 1.f, 1.f, 1.f }; ///< Of a block, workspace.
    std::array<int, 3> Size = { 1, 1, 1 };
  };
  /**
   * Of an image, workspace, one corner of which is the origin. Along each axis the outermost blocks
   * share what whole ones leave; what is shorter than two of them is one block.
   */
  static Frame FrameOf(const std::array<double, 3>& extent, double side);

  // All in delta.
  static constexpr float MovingInDelta = 2.5f;
  static constexpr float EditedInDelta = 3.f;
  static constexpr float WrittenInDelta = 7.5f;
  static constexpr float HaloInDelta = 14.2f;
  static constexpr float SideInDelta = 24.f;
  static constexpr int Colours = 8;

  SurfaceBlocks(SurfaceState& state, const Frame& frame, Executor& executor);
  ~SurfaceBlocks();
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** The order of their visits, and what waits for what; some have no vertices. */
  const VisitSchedule& Schedule() const { return *this->Visits; }
  /** The same blocks by colour, those of a colour in order of their number. */
  const std::array<std::vector<int>, Colours>& ByColour() const { return this->OfColour; }
  int NumberOfBlocks() const { return static_cast<int>(this->All.size()); }
  /** Of the surface; those of visits that are open count when these end. */
  int NumberOfVertices() const
  {
    const std::lock_guard<std::mutex> lock(this->Closing);
    return this->State.Mesh.NumberOfVertices();
  }

  /** Begins a visit. Others may be open that do not touch it. */
  BlockVisit Open(int block);
  /** Of the vertices of a list, those that are new are the open block's from now on. */
  void AddNew(BlockVisit& visit, const std::vector<int>& vertices) const;
  /**
   * Ends it: vertices that have left the block are others' from now on, and the state's number of
   * vertices and chi are those after the visit.
   */
  void Close(BlockVisit&& visit);

  /** Asks for what most of a block's vertices know, before a visit. */
  void Prefetch(int block) const;

  /** Whether a vertex of the block may move. */
  bool HasActive(int block) const;

  /** Places that a block would like to have for new vertices beyond those that it has. */
  int MissingPlaces(int block) const;
  /** Gives them, to each block as many; between sweeps. */
  void AddPlaces(const std::vector<int>& counts, Executor& executor);

  int BlockAt(const Vector& position) const;
  /** What a block fills; those at the border go on without end. */
  Box BoxOf(int block) const;
  /** Those that touch it, in order of their number. */
  std::vector<int> NeighboursOf(int block) const;
  /** Calls visit(block) for those within a distance, less than a side, of a position. */
  template <typename Visitor>
  void VisitNear(const Vector& position, float distance, Visitor&& visit) const
  {
    const std::array<int, 3> low = this->PlaceOf(position - Vector(distance, distance, distance));
    const std::array<int, 3> high = this->PlaceOf(position + Vector(distance, distance, distance));
    for (int z = low[2]; z <= high[2]; ++z)
    {
      for (int y = low[1]; y <= high[1]; ++y)
      {
        for (int x = low[0]; x <= high[0]; ++x)
        {
          visit(this->BlockOf({ x, y, z }));
        }
      }
    }
  }
  /** The vertices of a block, and some that no longer are, or are there twice. */
  const std::vector<int>& ListOf(int block) const { return this->All[block].Vertices; }
  /** Of all blocks; their places stay. */
  void ForgetVertices();
  /** New vertices, not of a visit: their blocks have them from now on. */
  void Take(const std::vector<int>& vertices);
  /** The place of a vertex of a block that another one's visit has removed. */
  void GiveBack(int block, int place) { this->All[block].Places.Free.push_back(place); }
  /** Vertices that have come from elsewhere, with their block. */
  void AddOthers(const std::vector<int>& vertices);
  const Frame& GetFrame() const { return this->TheFrame; }

  /**
   * A sum for each block of those that are asked for, 0 for the others: ofVertex(v) of the vertices
   * that it has now, in order of index.
   */
  std::vector<double> Sums(const std::function<bool(int block)>& isWanted,
    const std::function<double(int v)>& ofVertex, Executor& executor) const;

private:
  struct OfBlock
  {
    std::vector<int> Vertices; ///< Some are others' by now, or no more.
    VertexPlaces Places;       ///< For new vertices.
    UnusedPlaces Unused;
    int Taken = 0; ///< Of the places, by its last visit.
  };
  std::array<int, 3> PlaceOf(const Vector& position) const;
  std::array<int, 3> PlaceOf(int block) const;
  int BlockOf(const std::array<int, 3>& place) const;
  /** Leaves the vertices of the block, each once, in order. */
  void Clean(int block, std::vector<int>& vertices) const;
  void Collect(Executor& executor);
  void FindOrder();

  SurfaceState& State;
  Frame TheFrame;
  std::vector<OfBlock> All;
  VertexPlaces Others; ///< Free before, for nobody.
  std::unique_ptr<VisitSchedule> Visits;
  std::array<std::vector<int>, Colours> OfColour;
  mutable std::mutex Closing; ///< Held while a visit hands over what others have, too.
};
}

#endif
