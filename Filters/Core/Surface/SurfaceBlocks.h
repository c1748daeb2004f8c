// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceBlocks_h
#define volumicSurfaceBlocks_h

#include "Core/Common/Box.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * The vertices of a surface by cubes of space, the blocks, so that it can be worked on block by
 * block. The vertices of a block follow each other in memory (SurfaceMesh::Reorder along a curve
 * through the same cubes), and each block has places of its own for new ones: what is far away is
 * not touched, and may be out of memory (ScratchMemory) or on another rank (RankBlocks).
 *
 * What a visit does depends on the vertices in the block and about it only, as they are then, and
 * not on what is done elsewhere meanwhile. So blocks that do not touch may be visited in any order,
 * or at the same time on several ranks; those that touch are visited in the order of eight colours
 * (along each axis those of even place before those of odd place). Order() goes slab by slab, which
 * touches memory less often: 0, 2, 1, 4, 3, ... along each axis; ByColour() all of a colour first.
 */
class SurfaceBlocks
{
public:
  /** Where the blocks lie; the outermost go on without end. */
  struct Frame
  {
    Vector Low; ///< Where the first one begins: the corner of the image.
    /** Of a block, workspace; more than twice the halo where there are ranks. */
    std::array<float, 3> Side = { 1.f, 1.f, 1.f };
    std::array<int, 3> Size = { 1, 1, 1 };
  };
  /** Of an image, workspace, in as many blocks as bring their sides nearest to one. */
  static Frame FrameOf(const std::array<double, 3>& extent, double side);

  /**
   * How far about a block a visit may read, and how far it may write, in delta. Edits follow each
   * other outward over five iterations: 14 delta have been seen.
   */
  static constexpr float HaloInDelta = 24.f;
  static constexpr float WrittenInDelta = 20.f;
  static constexpr int Colours = 8;

  SurfaceBlocks(SurfaceState& state, const Frame& frame, Executor& executor);
  ~SurfaceBlocks();
  SurfaceBlocks(const SurfaceBlocks&) = delete;
  SurfaceBlocks& operator=(const SurfaceBlocks&) = delete;

  /** In the order of their visits; some have no vertices. */
  const std::vector<int>& Order() const { return this->Visits; }
  /** The same blocks by colour, those of a colour in order of their number. */
  const std::array<std::vector<int>, Colours>& ByColour() const { return this->OfColour; }
  int NumberOfBlocks() const { return static_cast<int>(this->Visits.size()); }

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

  /** Places that a block would like to have for new vertices beyond those that it has. */
  int MissingPlaces(int block) const;
  /** Gives them, to each block as many; between sweeps. */
  void AddPlaces(const std::vector<int>& counts);

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
  const std::vector<int>& ListOf(int block) const { return this->Vertices[block]; }
  /** Of all blocks; their places stay. */
  void ForgetVertices();
  /** New vertices, not of a visit: their blocks have them from now on. */
  void Take(const std::vector<int>& vertices);
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
  struct OwnPlaces
  {
    VertexPlaces Places;
    UnusedPlaces Unused;
  };
  std::array<int, 3> PlaceOf(const Vector& position) const;
  std::array<int, 3> PlaceOf(int block) const;
  int BlockOf(const std::array<int, 3>& place) const;
  /** Leaves the vertices of the block, each once, in order. */
  void Clean(int block, std::vector<int>& vertices) const;
  void Collect(Executor& executor);
  void FindOrder();
  void MakeCanonical(int block);

  SurfaceState& State;
  Frame TheFrame;
  std::vector<std::vector<int>> Vertices; ///< Of each block; some are others' by now, or no more.
  std::vector<OwnPlaces> Places;          ///< Of each block, for new vertices.
  OwnPlaces Others;                       ///< Free before, for nobody.
  std::vector<int> Visits;
  std::array<std::vector<int>, Colours> OfColour;
  int Opened = NoBlock;
  std::ptrdiff_t OldOnes = 0; ///< Of its vertices, those that it had when it was opened: the first.
};
}

#endif
