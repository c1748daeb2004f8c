// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Levels whose blocks belong to several ranks: see RankBlocks. All ranks do the same
// steps at the same time.

#include "Core/Common/RankLists.h"
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

namespace volumic
{
void SurfaceEvolution::Implementation::FindGridBox(
  const SurfaceMesh& mesh, const std::vector<int>& own)
{
  this->FindGridBox(SurfaceMesh()); // At least that of the image.
  Box box = { this->GridLow, this->GridHigh };
  const float delta = this->State.Sizing.Largest();
  const Vector margin(2 * delta, 2 * delta, 2 * delta);
  for (const int v : own)
  {
    box = box.With({ mesh.Position[v] - margin, mesh.Position[v] + margin });
  }
  // Other cells would have their vertices looked at in another order.
  for (const Box& ofRank : GatherValues(*this->Ranks, box))
  {
    box = box.With(ofRank);
  }
  this->GridLow = box.Low;
  this->GridHigh = box.High;
}

void SurfaceEvolution::Implementation::BalanceRanks(bool onlyActive)
{
  if (this->Piece->Balance(onlyActive, this->Threads) && this->Voxels)
  {
    this->Voxels(this->OwnVoxels(), VoxelBox());
  }
}

std::vector<VoxelBox> SurfaceEvolution::Implementation::OwnVoxels() const
{
  // Those of the blocks, and of the halo, which is further than any vertex gets.
  const LevelImage& image = this->TheField->Image();
  const float halo = SurfaceBlocks::HaloInDelta * this->State.Sizing.Largest();
  const auto voxelsOf = [&](int block)
  {
    const Box box = this->Blocks->BoxOf(block).Grown(halo);
    const float low[3] = { box.Low.X, box.Low.Y, box.Low.Z };
    const float high[3] = { box.High.X, box.High.Y, box.High.Z };
    VoxelBox ofBlock;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double size = image.Size[axis];
      const double step = image.Step[axis];
      ofBlock.First[axis] =
        static_cast<int>(std::clamp(std::floor(low[axis] / step), 0., size));
      ofBlock.End[axis] =
        static_cast<int>(std::clamp(std::ceil(high[axis] / step) + 1., 0., size));
    }
    return ofBlock;
  };
  std::vector<VoxelBox> rows;
  const int along = this->Blocks->GetFrame().Size[0];
  for (int first = 0; first < this->Blocks->NumberOfBlocks(); first += along)
  {
    VoxelBox row;
    for (int block = first; block < first + along; ++block)
    {
      row = this->Piece->IsOwn(block) ? row.With(voxelsOf(block)) : row;
    }
    if (!row.IsEmpty())
    {
      rows.push_back(row);
    }
  }
  return rows;
}

void SurfaceEvolution::Implementation::EndVisits()
{
  if (!this->IsInPieces()) // Else it stays so until it is wanted as a whole.
  {
    this->ForgetBlocks();
  }
}

std::vector<int> SurfaceEvolution::Implementation::TakeOwnBlocks(
  BlocksToCome& toCome, bool areAwaited, std::int64_t& work, bool onlyActive) const
{
  const std::vector<int>& ofColour = this->Blocks->ByColour()[toCome.Colour];
  std::vector<int> own;
  for (; toCome.Place < ofColour.size() && work > 0; ++toCome.Place)
  {
    const int block = ofColour[toCome.Place];
    if (this->Piece->IsOwn(block) && this->Piece->IsAwaited(block) == areAwaited &&
      !this->Stopped)
    {
      const std::int64_t ofBlock = this->Blocks->WorkOf(block, onlyActive);
      if (ofBlock / 2 >= work) // Less would be left over.
      {
        work = 0;
        break;
      }
      work -= ofBlock;
      if (ofBlock > 0)
      {
        own.push_back(block);
      }
    }
  }
  return own;
}

void SurfaceEvolution::Implementation::VisitOwnBlocks(
  const std::vector<int>& own, const BlockVisits& visits)
{
  this->Piece->BeginVisits(own);
  ForSpans(this->Threads, own.size(), 1,
    [&](std::size_t i, std::size_t, std::size_t)
    { this->VisitBlock(own[i], visits, OnThisThread()); });
  this->Piece->EndVisits(own);
}

void SurfaceEvolution::Implementation::VisitBlocksOnRanks(
  const BlockVisits& visits, const std::function<bool(std::size_t done)>& goOn)
{
  constexpr std::int64_t all = std::numeric_limits<std::int64_t>::max();
  const RankBlocks::WorkByColour waits = this->Piece->WaitsOfSweep(visits.OnlyActive);
  BlocksToCome others;
  std::size_t visited = 0;
  const auto visitOthers = [&](int lastColour, std::int64_t work)
  {
    while (others.Colour <= lastColour && work > 0)
    {
      this->VisitOwnBlocks(this->TakeOwnBlocks(others, false, work, visits.OnlyActive), visits);
      const std::size_t ofColour = this->Blocks->ByColour()[others.Colour].size();
      if (others.Place == ofColour)
      {
        visited += ofColour;
        others = { others.Colour + 1, 0 };
      }
    }
  };
  // Those that others wait for come first; the time in which this rank would wait is for the others.
  for (int colour = 0; colour < SurfaceBlocks::Colours; ++colour)
  {
    BlocksToCome awaited{ colour, 0 };
    std::int64_t work = all;
    this->VisitOwnBlocks(this->TakeOwnBlocks(awaited, true, work, visits.OnlyActive), visits);
    visitOthers(colour, waits[static_cast<std::size_t>(colour)]);
    this->Piece->Exchange();
    goOn(visited);
  }
  for (int colour = 0; colour < SurfaceBlocks::Colours; ++colour)
  {
    visitOthers(colour, all);
    goOn(visited);
  }
  this->Stopped = this->Piece->ShareCounts(this->Stopped);
}

bool SurfaceEvolution::Implementation::IsOnAnyRank(bool isHere)
{
  return this->Sharers().IsAny(isHere);
}

void SurfaceEvolution::Implementation::AgreeOnStop()
{
  this->Stopped = this->IsOnAnyRank(this->Stopped);
}

void SurfaceEvolution::Implementation::AddUpRows(std::vector<SweptRow>& rows)
{
  struct Sums
  {
    int Counts[10];
    int Unchecked;
    double TimeStep;
    SentMessages Sent;
  };
  const auto countsOf = [](SweptRow& swept)
  {
    HistoryRow& row = swept.Row;
    return std::array<int*, 10>{ &row.ActiveVertices, &row.Merges, &row.Cuts, &row.Splits,
      &row.Collapses, &row.Flips, &row.Deletions, &row.DeletedGenus, &swept.Vertices,
      &swept.EulerCharacteristic };
  };
  std::vector<Sums> own;
  for (SweptRow& swept : rows)
  {
    own.push_back({ {}, this->Unchecked, swept.Row.TimeStep, swept.Row.Sent });
    int* count = own.back().Counts;
    for (int* const ofRow : countsOf(swept))
    {
      *count++ = std::exchange(*ofRow, 0);
    }
  }
  for (const std::vector<Sums>& ofRank : GatherEachOnAll(this->Sharers(), own))
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const int* count = ofRank[i].Counts;
      for (int* const ofRow : countsOf(rows[i]))
      {
        *ofRow += *count++;
      }
      HistoryRow& row = rows[i].Row;
      row.TimeStep = std::max(row.TimeStep, ofRank[i].TimeStep);
      row.Sent.Bytes = std::max(row.Sent.Bytes, ofRank[i].Sent.Bytes);
      row.Sent.Messages = std::max(row.Sent.Messages, ofRank[i].Sent.Messages);
      this->Unchecked = std::max(this->Unchecked, ofRank[i].Unchecked);
    }
  }
}

void SurfaceEvolution::Implementation::AddUpSinceEvolved()
{
  const EditCounts own = this->SinceEvolved;
  this->SinceEvolved = EditCounts();
  for (const EditCounts& ofRank : GatherValues(this->Sharers(), own))
  {
    this->SinceEvolved += ofRank;
  }
}

void SurfaceEvolution::Implementation::CountComponents()
{
  this->Piece->ShareCounts();
  this->NumberOfComponents = this->Components->NumberOfComponents();
}

void SurfaceEvolution::Implementation::LabelComponents()
{
  this->Components->Label(this->State, this->Threads);
  this->NumberOfComponents = this->Components->NumberOfComponents();
}

void SurfaceEvolution::Implementation::DeleteDegenerate()
{
  this->Components->DeleteDegenerate(this->State);
  this->CountComponents();
}

void SurfaceEvolution::Implementation::DeleteThoseInsideOut()
{
  this->Components->DeleteInsideOut(this->State, this->Threads);
  this->CountComponents();
  this->Unchecked = 0;
}

std::vector<std::uint8_t> SurfaceEvolution::Implementation::AreNear(
  std::vector<std::int64_t> voxels)
{
  Communicator& ranks = this->Sharers();
  voxels = BroadcastList(ranks, voxels); // Rank 0 alone knows of what was lost.
  MessageWriter writer;
  writer.AddArray(LostBoundary::AreNear(voxels, this->State, *this->TheField, this->Threads));
  std::vector<std::uint8_t> areNear(ranks.Rank() == 0 ? voxels.size() : 0, 0);
  for (const Message& message : ranks.Gather(writer.Take()))
  {
    const auto ofRank = MessageReader(message).TakeVector<std::uint8_t>();
    for (std::size_t i = 0; i < areNear.size(); ++i)
    {
      areNear[i] |= ofRank[i];
    }
  }
  return areNear;
}

void SurfaceEvolution::Implementation::LeaveBlocks()
{
  if (this->IsInPieces())
  {
    this->OwnAtRest = this->OwnVertices();
  }
  this->ForgetBlocks();
}

void SurfaceEvolution::Implementation::Unite()
{
  this->LeaveBlocks();
  if (this->OwnAtRest)
  {
    this->State.Mesh =
      GatherMesh(*this->Ranks, std::move(this->State.Mesh), *this->OwnAtRest);
    this->OwnAtRest.reset();
  }
}
}
