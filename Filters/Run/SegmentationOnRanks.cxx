// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What of a run all ranks share, and what rank 0 asks of the others for it.

#include "Run/SurfaceSegmentation.h"

#include "Run/RankLevel.h"

#include <algorithm>
#include <utility>

namespace volumic
{
bool SurfaceSegmentation::MayBeShared(int level) const
{
  // Snapshots, mean or graded edges, and what attracts are for the whole surface, on one rank.
  return this->Request.OnAllRanks && level < this->Choice.Coarsest && level >= 0 &&
    SurfaceEvolution::AreShared(
      this->Settings.Options, this->Levels.Pyramid().SizeOf(level)) &&
    this->Settings.SnapshotInterval == 0 && this->Settings.EdgeLength == 0.0 &&
    !(this->Settings.Grading.IsWanted() && level == this->Settings.End.FinestLevel) &&
    !this->Levels.HasPoints() && !this->Levels.HasEdges();
}

SharedLevel::Next SurfaceSegmentation::AfterShared(int level) const
{
  const CheckpointRequest& checkpoints = this->Request.Checkpoints;
  // From level 0 only the run to level -1 goes on, or one from a checkpoint that stays.
  if (level == 0 && this->Choice.Last == 0 && !(checkpoints.AreLeft && checkpoints.Stay))
  {
    return SharedLevel::Next::Ends;
  }
  // What is saved is the whole surface.
  const bool staysInPieces = level > this->Choice.Last && this->MayBeShared(level - 1) &&
    !checkpoints.AreLeft && !this->Request.MayGoOn;
  return staysInPieces ? SharedLevel::Next::StaysInPieces : SharedLevel::Next::IsWhole;
}

bool SurfaceSegmentation::NeedsWholeResult() const
{
  return this->Request.KeepsWhole || this->Request.Checkpoints.AreLeft ||
    this->Settings.End.KeepComponents != KeepComponentsType::AllComponents;
}

void SurfaceSegmentation::GatherVoxels(int level)
{
  SharedLevel shared;
  shared.Is = SharedLevel::Work::GivesVoxels;
  shared.Level = std::max(level, 0);
  const LevelImage image =
    this->Levels.Load(shared.Level, this->Settings.Options, *this->Threads);
  this->Request.OnAllRanks(
    [&] { ShareLevel(*this->Request.Ranks, shared, image, this->Levels.InPieces()); });
  this->Levels.TakeWhole(level);
}

void SurfaceSegmentation::MakeOutput(SegmentationResults::Level& result, SurfaceResult surface)
{
  const auto make = [&]
  { this->Found.MakeSurface(result, std::move(surface), *this->Threads); };
  if (surface.Piece.IsWhole())
  {
    make();
    return;
  }
  this->Request.OnAllRanks(
    [&]
    {
      ShareOutput(*this->Request.Ranks, result.Description.Level, this->Levels.GetWorkspace(),
        this->Settings.End.NumberOfThreads);
      make();
    });
}
}
