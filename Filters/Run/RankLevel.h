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
#include "Input/Workspace.h"
#include "Output/RankOutputs.h"
#include "Output/SegmentationResults.h"
#include "Run/EvolutionAtRest.h"
#include "Settings/SegmentationVolume.h"

#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace volumic
{
/** A level that a surface evolves on over several ranks: what each of them has of it. */
class RankLevel
{
public:
  /**
   * By all ranks together.
   * @param image at rank 0 the level, with all its voxels or room for them; the others learn of it
   *        here
   * @param pieces the voxels that are not there, but with the ranks; null: rank 0 has all
   * @param takes  whether they are wanted here for the last time: a piece that nobody else has is
   *               taken, lest its voxels be twice in memory
   */
  RankLevel(
    Communicator& ranks, const LevelImage& image, LevelInPieces* pieces, bool takes);

  /**
   * At rank 0 its voxels are where they were; elsewhere there is room for them, empty until Need().
   */
  const LevelImage& Image() const { return this->Level; }

  /**
   * By all ranks together: brings this rank the voxels of some boxes that it has not.
   * @param share see SurfaceEvolution::NeedVoxels: it has them for others from then on; of a piece
   *        that it has taken the rest is let go
   */
  void Need(const std::vector<VoxelBox>& boxes, const VoxelBox& share = VoxelBox());
  /** By all ranks together: brings rank 0 what Field asks of a whole image. */
  void NeedMeasures();

private:
  void TakePiece(LevelInPieces& pieces);
  void LetGo(const VoxelBox& box);
  void Fetch(const std::vector<VoxelBox>& boxes);

  Communicator& Ranks;
  LevelImage Level;
  const bool StaysInPieces;
  VoxelPieces Pieces;
  const void* Held = nullptr; ///< this rank's piece,
  VoxelBox Layout;            ///< in the rows of this box
  bool IsTaken = false;       ///< It is in the room for the level.
  std::vector<VoxelBox> Fetched; ///< by Need(), or taken
  LargeVector<char> Voxels;   ///< of the whole level; written where they are needed
  char* Room = nullptr;       ///< these, or those of rank 0
};

/** What rank 0 of a run shares with those that help it. */
struct SharedLevel
{
  enum class Work
  {
    Evolves,     ///< All evolve the surface.
    Unites,      ///< Rank 0 wants the mesh that is in pieces.
    GivesVoxels, ///< Rank 0 wants all voxels, and does the rest alone.
    MakesOutput, ///< All make outputs of their pieces,
    MakesOutputAgain ///< of those that they have kept.
  };
  Work Is = Work::Evolves;
  SurfaceOptions Options;
  int Level = 0;
  double MeanEdgeLength = 0.; ///< SurfaceEvolution::SetMeanEdgeLength()
  int NumberOfThreads = 0;
  bool IsInPieces = false; ///< The mesh that is to evolve there; else rank 0 has it.
  bool KeepsRest = false;  ///< A stop leads back to it.
  bool GoesOn = false;     ///< Something may come after that level.
  bool TakesVoxels = false; ///< See RankLevel.
  bool KeepsPieces = false; ///< Outputs may be wanted of other components.
  bool MakesPieces = false; ///< Its output is not whole: each rank makes its own piece.
};

struct HelpersRun;

/** What a rank that helps keeps of surfaces of which each has a piece, rank 0, too. */
struct HelpersPiece
{
  SurfaceResult Result; ///< until the output is made of it
  PiecesOfLevels Outputs;
  /** With all components, where others may be wanted: by level. */
  std::map<int, std::shared_ptr<const SurfaceResult>> Kept;
  std::shared_ptr<HelpersRun> Run; ///< What evolves it, between levels; else null.
};

/**
 * At rank 0, while the other ranks are in HelpWithLevel(): divides the surface to a level that all
 * ranks share, and evolves it there. Afterwards rank 0 has the result, or its piece of it, and the
 * evolution has left the level, in pieces.
 * @param rest of all ranks what rests before it is divided, where that is to be kept, and all have
 *        had room for it
 * @return false as SurfaceEvolution::Divide()
 */
bool EvolveOnRanks(Communicator& ranks, const SharedLevel& shared,
  std::unique_ptr<RankLevel> level, SurfaceEvolution& evolution, EvolutionAtRest& rest,
  StopReason& reason, SurfaceResult& surface);

/** At rank 0, likewise: SurfaceEvolution::Unite(). */
void UniteOnRanks(Communicator& ranks, SurfaceEvolution& evolution);

/**
 * At rank 0, likewise: tells the others of a level whose voxels it wants, or on which all evolve.
 */
std::unique_ptr<RankLevel> ShareLevel(Communicator& ranks, const SharedLevel& shared,
  const LevelImage& image, LevelsInPieces& pieces);

/**
 * At rank 0, likewise: all make outputs of their pieces. @param result rank 0's, with its description
 * @param shared what is made, KeepsPieces, and threads
 */
void MakeOutputOnRanks(Communicator& ranks, SharedLevel shared,
  SegmentationResults::Level& result, SurfaceResult surface, const ComponentChoice& choice,
  const Workspace& space, Executor& threads);

/**
 * At the others, until rank 0 is done.
 * @param pieces of the voxels; those of levels that the surface has left are let go of
 * @param piece  what this rank keeps of the surface
 * @param goOn   asked now and then; false ends the run of all
 */
void HelpWithLevel(Communicator& ranks, LevelsInPieces& pieces, HelpersPiece& piece,
  const std::function<bool()>& goOn);
}

#endif
