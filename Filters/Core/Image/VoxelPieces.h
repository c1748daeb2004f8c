// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelPieces_h
#define volumicVoxelPieces_h

#include "Core/Common/Communicator.h"
#include "Core/Image/VoxelBox.h"

#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * Which voxels of an image each rank holds: a box, or none. Boxes may share voxels, as the pieces
 * of VTK's images share a layer; then all have the same values there. All ranks know all boxes.
 */
class VoxelPieces
{
public:
  /** Of no rank. */
  VoxelPieces() = default;

  /** By all ranks together. @param held by this one */
  VoxelPieces(Communicator& ranks, const VoxelBox& held);

  const VoxelBox& HeldBy(int rank) const { return this->Held[static_cast<std::size_t>(rank)]; }

  /** The smallest box about all that is held. */
  VoxelBox Bounds() const;

  /** Whether each voxel of a box is held by a rank. */
  bool HoldAll(const VoxelBox& box) const;

  /**
   * The voxels that a rank holds and no lower one does, in boxes apart from each other: those of
   * all ranks have each voxel once.
   */
  std::vector<VoxelBox> OwnOf(int rank) const;

  /**
   * By all ranks together: brings each the voxels of the box that it wants, its own from its own
   * memory, others from the lowest rank that holds them. Ranks that bring each other nothing send
   * each other nothing but the boxes. Voxels that nobody holds stay as they are in `fetched`.
   * @param voxels  that this rank holds, x fastest
   * @param bytes   of a voxel, the same on all ranks
   * @param fetched room for the voxels of `wanted`, x fastest
   */
  void Fetch(Communicator& ranks, const void* voxels, std::size_t bytes, const VoxelBox& wanted,
    void* fetched) const;

  /**
   * The same for some boxes, which go together, where `fetched` has room for a larger one, of which
   * other voxels stay as they are.
   * @param layout the box that `voxels` has room for: what this rank holds, or more
   */
  void FetchInto(Communicator& ranks, const void* voxels, const VoxelBox& layout,
    std::size_t bytes, const std::vector<VoxelBox>& wanted, const VoxelBox& place,
    void* fetched) const;

  template <typename T>
  void Fetch(Communicator& ranks, const T* voxels, const VoxelBox& wanted, T* fetched) const
  {
    this->Fetch(ranks, voxels, sizeof(T), wanted, fetched);
  }

  /**
   * A rank gets about so many bytes at a time: what is on the way takes that much memory, beside
   * what is sent.
   */
  std::size_t BytesAtATime = std::size_t(16) << 20;

private:
  /** Voxels that a rank gets from another one. */
  struct Delivery
  {
    int From;
    VoxelBox Box;
  };
  std::vector<Delivery> DeliveriesFor(int rank, const std::vector<VoxelBox>& wanted) const;
  /** @param wanted by rank */
  void FetchOnce(Communicator& ranks, const char* voxels, const VoxelBox& layout,
    std::size_t bytes, const std::vector<std::vector<VoxelBox>>& wanted, const VoxelBox& place,
    char* fetched) const;

  std::vector<VoxelBox> Held; ///< by rank
};
}

#endif
