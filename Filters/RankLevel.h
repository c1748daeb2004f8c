// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankLevel_h
#define volumicRankLevel_h

#include "Core/Common/Communicator.h"
#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Image/VoxelPieces.h"

#include <functional>

namespace volumic
{
/** A level that a surface evolves on over several ranks: what each of them has of it. */
class RankLevel
{
public:
  /**
   * By all ranks together. @param image at rank 0 the level with all its voxels, which stay in their
   * place; the other ranks learn of it here
   */
  RankLevel(Communicator& ranks, const LevelImage& image);

  /** At rank 0 as given; else with room for all voxels, which takes no memory before Need(). */
  const LevelImage& Image() const { return this->Level; }

  /** By all ranks together: brings this rank the voxels of a box, and no others. */
  void Need(const VoxelBox& box);

private:
  Communicator& Ranks;
  LevelImage Level;
  VoxelPieces Pieces;
  LargeVector<char> Voxels; ///< of the whole level; written where they are needed
};

/** What rank 0 of a run shares with those that help it. */
struct SharedLevel
{
  SurfaceOptions Options;
  int Level = 0;
  int NumberOfThreads = 0;
  bool IsLast = false; ///< The surface does not go on from there.
};

/**
 * At rank 0: the division to a level in sweeps, and the run there, on all ranks; they must be in
 * HelpWithLevel(). @return false as SurfaceEvolution::Divide().
 */
bool EvolveOnRanks(Communicator& ranks, const SharedLevel& shared, const LevelImage& image,
  SurfaceEvolution& evolution, StopReason& reason, SurfaceResult& surface);

/** At the others. @param goOn asked now and then; false ends the run on all ranks */
void HelpWithLevel(Communicator& ranks, const std::function<bool()>& goOn);
}

#endif
