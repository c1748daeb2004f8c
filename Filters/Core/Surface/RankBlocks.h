// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankBlocks_h
#define volumicRankBlocks_h

#include "Core/Common/Box.h"
#include "Core/Common/Communicator.h"
#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Surface/SurfaceBlocks.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * The blocks of a surface that evolves on one rank or several: each belongs to one of them, which
 * visits it. A rank has the vertices of its own blocks and, as a halo, those near them, with the indices
 * that they have everywhere; the places of all others are there, but take no memory.
 *
 * The ranks visit their blocks of two colours, which differ along x, then tell each other what has
 * become of the vertices near the borders (Exchange), then go on with the next two. A row of blocks
 * along x is of one rank, and other blocks of these colours do not touch: each visit sees what it
 * would see on one rank. Messages grow with the border of the ranks.
 */
class RankBlocks
{
public:
  /** All are of rank 0 until owners are chosen. */
  RankBlocks(SurfaceState& state, SurfaceBlocks& blocks, Communicator& ranks);

  /** Those that have a piece of the surface; one alone has all of it. */
  Communicator& Sharers() const { return this->Ranks; }
  bool AreShared() const { return this->Ranks.NumberOfRanks() > 1; }

  /**
   * Which rank gets which block, so that each has as many vertices as is possible with boxes of
   * blocks: the rows of blocks along x are cut along y and z, again and again, into halves.
   * @param vertices of each block @return by block
   */
  static std::vector<int> ChooseOwners(
    const SurfaceBlocks::Frame& frame, const std::vector<int>& vertices, int ranks);

  /** The same on all ranks, of a mesh that is whole on rank 0. */
  void ChooseOwners(const SurfaceMesh& mesh);
  void SetOwners(std::vector<int> owners);
  int OwnerOf(int block) const { return this->Owners[block]; }
  bool IsOwn(int block) const { return this->Owners[block] == this->Ranks.Rank(); }
  /** Of a vertex that is here. */
  bool IsOwnVertex(int v) const { return this->IsOwn(this->State.Block[v]); }

  /**
   * From a surface that is whole on rank 0 to one that each rank has its piece of. `low`, `high`:
   * the box of the grid, the same on all ranks.
   */
  void Scatter(const Vector& low, const Vector& high);
  /** The same for a mesh of which nothing else is known. */
  void ScatterMesh(const SurfaceMesh& mesh, const Vector& low, const Vector& high);
  /** Back again: rank 0 has all vertices, the others none. */
  void Gather();

  /**
   * A closed surface that is added to that of all ranks, the same on each: they keep what is near
   * them of it. Its vertices follow all others, as on one rank.
   */
  void Append(const IndexedSurface& surface, Executor& executor);
  /** The rows of an image beside own blocks: each row is of one rank. */
  VoxelBox RowsOf(const LevelImage& image) const;

  /** About a visit of an own block. */
  void BeginVisit(int block);
  void EndVisit(int block);
  /** After the visits of two colours. */
  void Exchange();
  /** Between sweeps: how many vertices there are, and the Euler characteristic, of all. */
  void ShareCounts();
  /** SurfaceBlocks::AddPlaces, as the owners wish. */
  void AddPlaces(Executor& executor);
  /** The sum of what the owners have of their blocks, added in the order of the blocks. */
  double AddUp(const std::vector<double>& ofBlocks);

private:
  /** A vertex that a visit has removed, and whose place it had. */
  struct Removed
  {
    int Vertex;
    int Block;
  };
  struct Sizes
  {
    std::size_t Places;
    int Vertices;
    int Characteristic;
  };
  /** Of values of blocks those of own ones, and those of all ranks' own ones put together. */
  template <typename T>
  std::vector<T> OfOwn(const std::vector<T>& ofBlocks) const;
  template <typename T>
  std::vector<T> InOrder(const std::vector<std::vector<T>>& ofRanks) const;
  Message SendPieces(const SurfaceMesh& mesh,
    const std::function<void(MessageWriter&, const std::vector<int>&)>& write);
  void BeginPieces(const Sizes& sizes, const Vector& low, const Vector& high);
  void CollectNear(const Vector& position, int v);
  void CollectZone(int block);
  bool IsNearOwn(const Vector& position) const;
  float Halo() const { return SurfaceBlocks::HaloInDelta * this->State.Sizing.Largest(); }

  SurfaceState& State;
  SurfaceBlocks& Blocks;
  Communicator& Ranks;
  std::vector<int> Owners;               ///< By block.
  std::vector<char> IsAtBorder;          ///< By block: it is own, and a neighbour is not.
  std::vector<int> Partners;             ///< Ranks with blocks beside own ones, and this one.
  std::vector<std::vector<int>> Touched; ///< By rank: what it must be told of.
  Vector Low, High;                      ///< Of the grid.
  int KnownVertices = 0;                 ///< When the ranks last agreed.
  int KnownCharacteristic = 0;
};
}

#endif
