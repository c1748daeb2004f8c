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

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The blocks of a surface that evolves on one rank or several: each belongs to one of them, which
 * visits it. A rank has the vertices of its own blocks and, as a halo, those near them, with the indices
 * that they have everywhere; the places of all others are there, but take no memory.
 *
 * The ranks visit those of their blocks of a colour that others wait for (IsAwaited), then tell each
 * other what has become of the vertices near the borders (Exchange), then go on with the next one.
 * All other blocks are for the time that a rank would wait for others (WaitsOfSweep), and for when
 * nobody waits any more. Blocks that touch are visited in the order of their colours: each visit sees
 * what it would see on one rank. Messages grow with the border of the ranks. Blocks go from rank to
 * rank (Balance) so that all have as much to do in a sweep; who owns what, and what is done while
 * others are waited for, has no influence on what becomes of the surface.
 */
class RankBlocks
{
public:
  /** All blocks belong to rank 0 until owners are chosen. */
  RankBlocks(SurfaceState& state, SurfaceBlocks& blocks, Communicator& ranks);

  /** The ranks that have pieces of the surface; one alone has all of it. */
  Communicator& Sharers() const { return this->Ranks; }
  bool AreShared() const { return this->Ranks.NumberOfRanks() > 1; }

  /**
   * Chooses an owner for each block, so that all ranks have about as many vertices: the rows of
   * blocks along x are cut along y and z, again and again, into halves.
   * @param vertices of each block @return the rank of each block
   */
  static std::vector<int> ChooseOwners(
    const SurfaceBlocks::Frame& frame, const std::vector<int>& vertices, int ranks);

  /** What there is to do with a block, see SurfaceBlocks::WorkOf(), and to move with it. */
  struct Load
  {
    std::int64_t Work = 0;
    std::int64_t Vertices = 0;
  };
  /**
   * Others, so that all ranks have as much to do: blocks in order along an axis are cut into halves,
   * again and again, along axes for which many owners stay what they are. Blocks without vertices
   * keep theirs.
   * @param loads of each block @return the rank of each block
   */
  static std::vector<int> BalancedOwners(const SurfaceBlocks& blocks,
    const std::vector<Load>& loads, const std::vector<int>& before, int ranks);
  /** What the rank with the most has to do in a sweep. */
  static std::int64_t WorkOfSweep(
    const std::vector<Load>& loads, const std::vector<int>& owners, int ranks);

  /** By colour, in looks at a vertex. */
  using WorkByColour = std::array<std::int64_t, SurfaceBlocks::Colours>;
  /** What a rank has to do in a sweep before others can go on. */
  struct Turns
  {
    WorkByColour Awaited{};    ///< With blocks that others wait for.
    std::vector<int> Partners; ///< Ranks that it tells of its visits, and that tell it of theirs.
  };
  /** How long a rank waits for its partners after its awaited blocks of each colour. */
  static WorkByColour WaitsOf(int rank, const std::vector<Turns>& ofRanks);

  /** By all ranks: chooses owners for a mesh of which each has some vertices, its own ones. */
  void ChooseOwners(const SurfaceMesh& mesh, const std::vector<int>& own);
  void SetOwners(std::vector<int> owners);
  int OwnerOf(int block) const { return this->Owners[block]; }
  bool IsOwn(int block) const { return this->Owners[block] == this->Ranks.Rank(); }
  /**
   * Whether blocks of other ranks cannot be visited before this own one: it is at the border, or
   * touches one that is and comes before it, or one that touches such a one, and so on.
   */
  bool IsAwaited(int block) const { return this->Awaited[block]; }
  /** Whether a vertex that is here belongs to a block of this rank. On any thread. */
  bool IsOwnVertex(int v) const { return this->IsOwn(this->State.Block[v]); }

  /**
   * By all ranks: each has its piece afterwards, with the halo, of a mesh of which each has some
   * vertices, its own ones; it may be whole on one of them. Its vertices know nothing else: they are
   * as after a reset. `low`, `high`: the box of the grid, the same on all ranks.
   */
  void Scatter(const SurfaceMesh& mesh, const std::vector<int>& own, const Vector& low,
    const Vector& high);

  /**
   * By all ranks, with the same surface: adds this closed surface to that of all ranks, each of
   * which keeps what is near its blocks. Its vertices follow all others, as on one rank.
   */
  void Append(const IndexedSurface& surface, Executor& executor);
  /**
   * The rows of voxels of an image that this rank looks after; each row has one such rank. As long
   * as the owners are those chosen first.
   */
  VoxelBox RowsOf(const LevelImage& image) const;

  /** To be called before, and after, visits of own blocks of a colour. */
  void BeginVisits(const std::vector<int>& blocks);
  void EndVisits(const std::vector<int>& blocks);
  /** By all ranks, after visits of a colour: tells what has become of vertices at borders. */
  void Exchange();
  /**
   * By all ranks, before a sweep: has blocks visited by other ranks from then on, with all that is
   * known of their vertices, where that saves a good part of the sweep.
   * @return whether any has gone, on all ranks: then the ranks need other voxels
   */
  bool Balance(bool onlyActive, Executor& executor);
  /** By all ranks, before a sweep: how long this one will wait in it, by WorkOf() of its blocks. */
  WorkByColour WaitsOfSweep(bool onlyActive) const;
  /**
   * By all ranks, between sweeps: agrees on the number of vertices and chi of the surface.
   * @return whether something else is so on any rank, as `isHere` tells of this one
   */
  bool ShareCounts(bool isHere = false);
  /** By all ranks, between sweeps: gives blocks the places that their owners want for them. */
  void AddPlaces(Executor& executor);
  /** By all ranks: adds up what the owners say of their blocks, each list in the blocks' order. */
  std::vector<double> AddUp(const std::vector<std::vector<double>>& lists);

private:
  /** A vertex that a visit has removed, and the block that its place belongs to. */
  struct Removed
  {
    int Vertex;
    int Block;
  };
  std::vector<Load> LoadsOfBlocks(bool onlyActive, Executor& executor) const;
  void MoveBlocks(std::vector<int> owners);
  void FindAwaited();
  /** By all ranks: what is known of blocks goes to new owners. @param before who owned them */
  void SendBlocks(const std::vector<int>& before);
  /** By all ranks: what is known of own vertices goes to all others that have blocks near them. */
  void SendVertices(const std::vector<int>& vertices);
  /** Whether a block, or one that touches it, has another owner than before. */
  bool IsNearMoved(int block, const std::vector<int>& before) const;
  /** Ranks with blocks near a vertex must be told of it. @param exceptFor this one, or -1 */
  void CollectNear(const Vector& position, int v, int exceptFor);
  /** Vertices that the visit of an own block may write, and others may have in their halo. */
  std::vector<int> BorderOf(int block) const;
  bool IsNearOwn(const Vector& position) const;
  float Halo() const { return SurfaceBlocks::HaloInDelta * this->State.Sizing.Largest(); }

  SurfaceState& State;
  SurfaceBlocks& Blocks;
  Communicator& Ranks;
  std::vector<int> Owners;               ///< By block.
  std::vector<char> IsAtBorder;          ///< By block: whether it is own and a neighbour is not.
  std::vector<char> Awaited;             ///< By block: see IsAwaited().
  std::vector<int> Partners;             ///< This rank, and those with blocks beside own ones.
  std::vector<std::vector<int>> Touched; ///< By rank: the vertices that it must be told of.
  /** What they may know so far: what was there before the visits. */
  struct KnownVertices
  {
    std::vector<int> Vertices;
    std::vector<Vector> Positions;
    std::vector<std::uint64_t> Hashes;
  } Known;
  int NumberOfVertices = 0;              ///< What the ranks last agreed on.
  int EulerCharacteristic = 0;
};
}

#endif
