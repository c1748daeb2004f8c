// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What of a run all ranks share, and what rank 0 asks of the others for it.

#include "Run/SurfaceSegmentation.h"

#include "Core/Common/Join.h"
#include "Run/RankLevel.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace volumic
{
const char* SurfaceSegmentation::WhyAlone(int level) const
{
  const Grading& grading = this->Settings.Grading;
  const bool isGraded = grading.IsWanted() && level == this->Settings.End.FinestLevel;
  const std::pair<bool, const char*> reasons[] = {
    { level >= this->Choice.Coarsest, "the surface starts there" },
    { isGraded && grading.HasTolerance(), "Tolerance is set" },
    { isGraded, "Thin Parts is on" },
    { this->Settings.SnapshotInterval != 0, "Snapshot Interval is set" },
    { this->Levels.HasPoints(), "points attract" },
    { this->Levels.HasEdges(), "a map of edges attracts" } };
  const auto* reason = std::find_if(std::begin(reasons), std::end(reasons),
    [](const std::pair<bool, const char*>& each) { return each.first; });
  return reason == std::end(reasons) ? nullptr : reason->second;
}

bool SurfaceSegmentation::MayBeShared(int level) const
{
  return this->IsForAllRanks(level) && !this->WhyAlone(level);
}

bool SurfaceSegmentation::IsForAllRanks(int level) const
{
  return this->Request.OnAllRanks &&
    SurfaceEvolution::AreShared(
      this->Settings.Options, this->Levels.Pyramid().SizeOf(std::max(level, 0)));
}

bool SurfaceSegmentation::EndsAt(int level) const
{
  // From level 0 only the run to level -1 goes on, or one from a checkpoint that stays.
  const CheckpointRequest& checkpoints = this->Request.Checkpoints;
  return level <= std::min(this->Choice.Last, 0) && !(checkpoints.AreLeft && checkpoints.Stay);
}

void SurfaceSegmentation::Unite()
{
  if (this->Evolution->IsInPieces())
  {
    this->Request.OnAllRanks([&] { UniteOnRanks(*this->Request.Ranks, *this->Evolution); });
  }
}

void SurfaceSegmentation::TakeAlone(int level)
{
  if (this->MayBeShared(level))
  {
    return;
  }
  this->Unite();
  const char* why = this->IsForAllRanks(level) ? this->WhyAlone(level) : nullptr;
  if (!why)
  {
    return;
  }
  if (this->ToldOfAlone.insert(why).second)
  {
    const bool isForOthers = level > this->Choice.Last && this->WhyAlone(level - 1) == why;
    this->Request.Warn(Join(isForOthers ? "From level " : "On level ", level,
      isForOthers ? " on" : "", " the first process holds all voxels, and finds the surface alone, "
      "as ", why, "."));
  }
  if (!this->Levels.IsInPieces(level))
  {
    return;
  }
  SharedLevel shared;
  shared.Is = SharedLevel::Work::GivesVoxels;
  shared.Level = std::max(level, 0);
  const LevelImage image =
    this->Levels.Load(shared.Level, this->Settings.Options, *this->Threads);
  this->Request.OnAllRanks(
    [&] { ShareLevel(*this->Request.Ranks, shared, image, this->Levels.InPieces()); });
  this->Levels.TakeWhole(level);
}

void SurfaceSegmentation::MakeOutput(const SegmentationRequest& request,
  SharedLevel::Work work, SegmentationResults::Level& result, SurfaceResult surface,
  const ComponentChoice& choice, const Workspace& space, Executor& threads)
{
  if (!result.IsPiece)
  {
    SegmentationResults::MakeSurface(result, std::move(surface), choice, space, threads);
    return;
  }
  SharedLevel shared;
  shared.Is = work;
  shared.KeepsPieces = request.KeepsAll;
  shared.NumberOfThreads = request.End.NumberOfThreads;
  request.OnAllRanks(
    [&]
    {
      MakeOutputOnRanks(
        *request.Ranks, shared, result, std::move(surface), choice, space, threads);
    });
}

bool SurfaceSegmentation::Choose(SegmentationResults& results,
  const SegmentationSettings& settings, const SegmentationRequest& request)
{
  return results.Choose(settings, request,
    [&](SegmentationResults::Level& level)
    {
      HostThreads threads(request.End.NumberOfThreads);
      threads.Run(
        [&]
        {
          MakeOutput(request, SharedLevel::Work::MakesOutputAgain, level, *level.All,
            results.Chosen(), results.GetWorkspace(), threads);
        });
    });
}
}
