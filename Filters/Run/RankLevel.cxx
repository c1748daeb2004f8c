// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RankLevel.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Monitor.h"
#include "Core/Common/RankLists.h"
#include "Core/Image/Field.h"
#include "Host/HostThreads.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Of a rank that helps: it shows nothing. */
class HelpersMonitor final : public Monitor
{
public:
  explicit HelpersMonitor(std::function<bool()> goOn) : Goes(std::move(goOn)) {}
  bool Continue(const Status&) override { return this->Goes(); }
  bool GoOn(const Status&) override { return this->Goes(); }

private:
  std::function<bool()> Goes;
};

/** @return that of rank 0 */
ComponentChoice BroadcastChoice(Communicator& ranks, ComponentChoice choice)
{
  choice.Mode = BroadcastValue(ranks, choice.Mode);
  choice.MinimumVolume = BroadcastValue(ranks, choice.MinimumVolume);
  choice.Places = BroadcastList(ranks, choice.Places);
  return choice;
}

void HelpWithOutput(Communicator& ranks, const SharedLevel& shared, HelpersPiece& piece)
{
  const auto space = BroadcastValue(ranks, Workspace());
  const ComponentChoice choice = BroadcastChoice(ranks, ComponentChoice());
  SurfaceResult surface;
  if (shared.Is == SharedLevel::Work::MakesOutputAgain)
  {
    surface = *piece.Kept.at(shared.Level);
  }
  else
  {
    surface = std::exchange(piece.Result, SurfaceResult());
    if (shared.KeepsPieces)
    {
      piece.Kept[shared.Level] = std::make_shared<const SurfaceResult>(surface);
    }
  }
  surface.Piece.Ranks = &ranks;
  HostThreads threads(shared.NumberOfThreads);
  threads.Run(
    [&]
    {
      SegmentationResults::Level made;
      SegmentationResults::MakeSurface(made, std::move(surface), choice, space, threads);
      piece.Outputs[shared.Level] = made.Surface;
    });
}

void Unite(Communicator& ranks, SurfaceEvolution& evolution)
{
  evolution.SetRanks(&ranks);
  evolution.Unite();
  evolution.SetRanks(nullptr);
}

/** Null where all voxels of the level are at rank 0. */
LevelInPieces* PiecesOf(LevelsInPieces& pieces, int level)
{
  const auto found = pieces.find(std::max(level, 0));
  return found != pieces.end() ? &found->second : nullptr;
}
}

/** What a rank that helps evolves its piece with. */
struct HelpersRun
{
  HelpersRun(const SharedLevel& shared, const std::function<bool()>& goOn)
    : Threads(shared.NumberOfThreads), Asked(goOn), Evolution(shared.Options, *Threads, Asked)
  {
  }
  std::optional<HostThreads> Threads; ///< Another run may want others, in the same place.
  HelpersMonitor Asked;
  SurfaceEvolution Evolution;
};

RankLevel::RankLevel(
  Communicator& ranks, const LevelImage& image, LevelInPieces* pieces, bool takes)
  : Ranks(ranks)
  , Level(BroadcastValue(ranks, image))
  , StaysInPieces(BroadcastValue(ranks, pieces != nullptr))
{
  const VoxelBox all = VoxelBox::Of(this->Level.Size);
  if (ranks.Rank() == 0)
  {
    // What it has room for it may fill.
    this->Room = const_cast<char*>(static_cast<const char*>(image.Values.Data()));
  }
  else
  {
    MakeZeroed(this->Voxels,
      static_cast<std::size_t>(all.Count()) * this->Level.Values.BytesPerVoxel());
    this->Room = this->Voxels.data();
  }
  this->Level.Values = this->Level.Values.At(this->Room);
  if (this->StaysInPieces)
  {
    this->Pieces = pieces->Pieces;
    this->Held = pieces->Values ? pieces->Values->GetVoidPointer(0) : nullptr;
    this->Layout = this->Pieces.HeldBy(ranks.Rank());
    if (takes && pieces->Values && pieces->Values->GetReferenceCount() == 1)
    {
      this->TakePiece(*pieces);
    }
  }
  else
  {
    this->Pieces = VoxelPieces(ranks, ranks.Rank() == 0 ? all : VoxelBox());
    this->Held = this->Room;
    this->Layout = this->Pieces.HeldBy(ranks.Rank());
  }
}

void RankLevel::TakePiece(LevelInPieces& pieces)
{
  const VoxelBox all = VoxelBox::Of(this->Level.Size);
  const std::size_t bytes = this->Level.Values.BytesPerVoxel();
  const VoxelBox& own = this->Layout;
  const char* row = static_cast<const char*>(this->Held);
  const std::size_t length = static_cast<std::size_t>(own.Length(0)) * bytes;
  for (int k = own.First[2]; k < own.End[2]; ++k)
  {
    for (int j = own.First[1]; j < own.End[1]; ++j, row += length)
    {
      std::memcpy(
        this->Room + static_cast<std::size_t>(all.NumberOf(own.First[0], j, k)) * bytes, row,
        length);
    }
  }
  pieces.Values = nullptr;
  this->Fetched.push_back(own);
  this->Held = this->Room;
  this->Layout = all;
  this->IsTaken = true;
}

void RankLevel::Fetch(const std::vector<VoxelBox>& boxes)
{
  this->Pieces.FetchInto(this->Ranks, this->Held, this->Layout,
    this->Level.Values.BytesPerVoxel(), boxes, VoxelBox::Of(this->Level.Size), this->Room);
}

void RankLevel::Need(const std::vector<VoxelBox>& boxes, const VoxelBox& share)
{
  std::vector<VoxelBox> lacking;
  for (std::size_t i = 0; i < boxes.size() && (this->Ranks.Rank() != 0 || this->StaysInPieces); ++i)
  {
    std::vector<VoxelBox> parts = { boxes[i] };
    for (const VoxelBox& had : this->Fetched)
    {
      parts = Without(parts, had);
    }
    lacking.insert(lacking.end(), parts.begin(), parts.end());
    this->Fetched.insert(this->Fetched.end(), parts.begin(), parts.end());
  }
  this->Fetch(lacking);
  const bool isSharedOut = this->StaysInPieces && this->Ranks.IsAny(!share.IsEmpty());
  if (isSharedOut && !this->Ranks.IsAny(!this->IsTaken))
  {
    std::vector<VoxelBox> left = { this->Pieces.HeldBy(this->Ranks.Rank()) };
    for (const VoxelBox& box : boxes)
    {
      left = Without(left, box);
    }
    for (const VoxelBox& box : left)
    {
      this->LetGo(box);
    }
    this->Pieces = VoxelPieces(this->Ranks, share);
    this->Fetched = boxes;
  }
}

void RankLevel::LetGo(const VoxelBox& box)
{
  const VoxelBox all = VoxelBox::Of(this->Level.Size);
  if (box.Length(0) < all.Length(0))
  {
    return; // Parts of rows have few pages of their own.
  }
  const std::size_t bytes = this->Level.Values.BytesPerVoxel();
  const std::size_t rows = static_cast<std::size_t>(box.Length(1)) * box.Length(0) * bytes;
  for (int k = box.First[2]; k < box.End[2]; ++k)
  {
    const auto first = static_cast<std::size_t>(all.NumberOf(0, box.First[1], k));
    GiveBackPages(this->Room + first * bytes, rows);
  }
}

void RankLevel::NeedMeasures()
{
  if (this->StaysInPieces)
  {
    std::vector<VoxelBox> measured;
    if (this->Ranks.Rank() == 0)
    {
      measured = Field::MeasuredVoxels(this->Level.Size);
    }
    this->Fetch(measured);
  }
}

std::unique_ptr<RankLevel> ShareLevel(Communicator& ranks, const SharedLevel& shared,
  const LevelImage& image, LevelsInPieces& pieces)
{
  BroadcastValue(ranks, shared);
  auto level = std::make_unique<RankLevel>(
    ranks, image, PiecesOf(pieces, shared.Level), shared.TakesVoxels);
  if (shared.Is == SharedLevel::Work::GivesVoxels)
  {
    level->Need({ VoxelBox::Of(image.Size) });
  }
  return level;
}

bool EvolveOnRanks(Communicator& ranks, const SharedLevel& shared,
  std::unique_ptr<RankLevel> level, SurfaceEvolution& evolution, EvolutionAtRest& rest,
  StopReason& reason, SurfaceResult& surface)
{
  rest.Drop();
  if (shared.KeepsRest && ranks.IsAny(!rest.Keep(evolution)))
  {
    rest.Drop(); // A piece of it would be of no use.
  }
  level->NeedMeasures();
  evolution.SetRanks(
    &ranks, [&level](const std::vector<VoxelBox>& boxes, const VoxelBox& share)
    { level->Need(boxes, share); });
  const bool isDivided = evolution.Divide(level->Image(), shared.Level);
  if (isDivided)
  {
    reason = evolution.Run();
    evolution.ForgetMotion();
    surface = shared.MakesPieces ? evolution.PieceOfResult() : evolution.Result();
    evolution.LeaveLevel();
  }
  evolution.SetRanks(nullptr);
  return isDivided;
}

void UniteOnRanks(Communicator& ranks, SurfaceEvolution& evolution)
{
  SharedLevel shared;
  shared.Is = SharedLevel::Work::Unites;
  BroadcastValue(ranks, shared);
  Unite(ranks, evolution);
}

namespace
{
void HelpToEvolve(Communicator& ranks, const SharedLevel& shared,
  std::unique_ptr<RankLevel> level, HelpersPiece& piece, const std::function<bool()>& goOn)
{
  std::shared_ptr<HelpersRun> run = std::move(piece.Run);
  if (!shared.IsInPieces)
  {
    run = std::make_shared<HelpersRun>(shared, goOn);
  }
  if (!run)
  {
    throw std::logic_error("A rank has not kept its piece of the surface.");
  }
  run->Threads.emplace(shared.NumberOfThreads);
  run->Evolution.SetMeanEdgeLength(shared.MeanEdgeLength);
  EvolutionAtRest rest;
  StopReason reason = StopReason::Cancelled;
  run->Threads->Run(
    [&]
    {
      EvolveOnRanks(
        ranks, shared, std::move(level), run->Evolution, rest, reason, piece.Result);
    });
  if (reason != StopReason::Cancelled)
  {
    piece.Run = shared.GoesOn ? std::move(run) : nullptr;
    return;
  }
  run.reset(); // As SurfaceSegmentation::ReturnToRest().
  if (rest.IsKept())
  {
    piece.Run = std::make_shared<HelpersRun>(shared, goOn);
    if (!rest.GiveTo(piece.Run->Evolution))
    {
      throw std::bad_alloc();
    }
  }
}
}

void MakeOutputOnRanks(Communicator& ranks, SharedLevel shared,
  SegmentationResults::Level& result, SurfaceResult surface, const ComponentChoice& choice,
  const Workspace& space, Executor& threads)
{
  shared.Level = result.Description.Level;
  BroadcastValue(ranks, shared);
  BroadcastValue(ranks, space);
  BroadcastChoice(ranks, choice);
  surface.Piece.Ranks = &ranks;
  SegmentationResults::MakeSurface(result, std::move(surface), choice, space, threads);
}

void HelpWithLevel(Communicator& ranks, LevelsInPieces& pieces, HelpersPiece& piece,
  const std::function<bool()>& goOn)
{
  const SharedLevel shared = BroadcastValue(ranks, SharedLevel());
  if (shared.Is == SharedLevel::Work::Unites)
  {
    Unite(ranks, std::exchange(piece.Run, nullptr)->Evolution);
    return;
  }
  if (shared.Is == SharedLevel::Work::MakesOutput ||
    shared.Is == SharedLevel::Work::MakesOutputAgain)
  {
    HelpWithOutput(ranks, shared, piece);
    return;
  }
  auto level = std::make_unique<RankLevel>(
    ranks, LevelImage(), PiecesOf(pieces, shared.Level), shared.TakesVoxels);
  if (shared.Is == SharedLevel::Work::GivesVoxels)
  {
    level->Need({});
    return;
  }
  for (auto coarser = pieces.upper_bound(std::max(shared.Level, 0)); coarser != pieces.end();
       ++coarser)
  {
    coarser->second.Values = nullptr; // As rank 0 has let go of them.
  }
  piece.Result = SurfaceResult();
  piece.Outputs.erase(shared.Level); // Rank 0 has forgotten it, too.
  piece.Kept.erase(shared.Level);
  HelpToEvolve(ranks, shared, std::move(level), piece, goOn);
  GiveBackFreeMemory();
}
}
