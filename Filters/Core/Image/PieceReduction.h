// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPieceReduction_h
#define volumicPieceReduction_h

#include "Core/Common/Executor.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/VoxelPieces.h"

#include <cstddef>
#include <cstdint>

namespace volumic
{
/** The voxels of a level that a rank holds, and which of them have a value. */
template <typename T>
struct MarkedVoxels
{
  const T* Values = nullptr; ///< x fastest
  const std::uint8_t* Marks = nullptr; ///< 1 or 0 each; only looked at where not all have a value
  bool HaveAllValues = true; ///< whether all voxels of all ranks have one
};

/** About how many bytes of the level below a rank fetches for a slab of the level that it makes. */
constexpr std::size_t BytesOfSlab = std::size_t(48) << 20;

/**
 * By all ranks together: a box of level h+1 for each, from level h, which they hold in pieces. The
 * boxes may share voxels, or be empty. What a rank lacks comes from the others (VoxelPieces), slab
 * by slab along z. The same bits as ReduceLevel() of the whole level, or ReduceValidVoxels().
 *
 * @param pieces      of level h: `below` are those of this rank
 * @param made        room for the voxels of this rank's piece of level h+1
 * @param progress    told the share of this rank's work that is done
 * @return false if `progress` asked to stop on any rank, on all of them; what is made is unfinished
 *         then.
 */
template <typename T>
bool ReducePieces(Communicator& ranks, const VoxelPieces& pieces, const MarkedVoxels<T>& below,
  const LevelGeometry& inputGeometry, typename RealOf<T>::Type* made, const LevelPiece& outputPiece,
  Executor& executor, const LevelProgress& progress, std::size_t bytesOfSlab = BytesOfSlab);
}

#endif
