// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Levels whose blocks belong to several ranks: see RankBlocks. All ranks do the same
// steps at the same time.

#include "Core/Common/RankLists.h"
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>

namespace volumic
{
void SurfaceEvolution::Implementation::ShareBlocks(const SurfaceMesh& mesh)
{
  this->MakeBlocks(*this->Ranks);
  this->Piece->ChooseOwners(mesh);
  if (this->NeedVoxels)
  {
    this->NeedVoxels(this->OwnVoxels());
  }
}

void SurfaceEvolution::Implementation::AgreeOnGridBox()
{
  // Other cells would have their vertices looked at in another order.
  this->GridLow = BroadcastValue(*this->Ranks, this->GridLow);
  this->GridHigh = BroadcastValue(*this->Ranks, this->GridHigh);
}

void SurfaceEvolution::Implementation::BalanceRanks(bool onlyActive)
{
  if (this->Piece->Balance(onlyActive, this->Threads) && this->NeedVoxels)
  {
    this->NeedVoxels(this->OwnVoxels());
  }
}

VoxelBox SurfaceEvolution::Implementation::OwnVoxels() const
{
  // Those of the blocks, and of the halo, which is further than any vertex gets.
  const LevelImage& image = this->TheField->Image();
  const float halo = SurfaceBlocks::HaloInDelta * this->State.Sizing.Largest();
  VoxelBox voxels;
  for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
  {
    if (!this->Piece->IsOwn(block))
    {
      continue;
    }
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
    voxels = voxels.With(ofBlock);
  }
  return voxels;
}

void SurfaceEvolution::Implementation::BeginVisits()
{
  if (!this->IsShared || this->IsInPieces())
  {
    return; // It has come here in blocks.
  }
  this->State.Sizing = SizingField(BroadcastValue(*this->Ranks, this->State.Sizing.OfLevel()));
  this->ShareBlocks(this->State.Mesh);
  this->AgreeOnGridBox();
  this->Piece->Scatter(this->GridLow, this->GridHigh);
}

void SurfaceEvolution::Implementation::EndVisits()
{
  if (!this->IsInPieces()) // Else it stays so until it is wanted as a whole.
  {
    this->ForgetBlocks();
  }
}

void SurfaceEvolution::Implementation::VisitBlocksOnRanks(
  const BlockVisits& visits, const std::function<bool(std::size_t done)>& goOn)
{
  std::size_t visited = 0;
  for (int colour = 0; colour < SurfaceBlocks::Colours; ++colour)
  {
    const std::vector<int>& ofColour = this->Blocks->ByColour()[colour];
    std::vector<int> own;
    std::copy_if(ofColour.begin(), ofColour.end(), std::back_inserter(own),
      [&](int block)
      {
        return this->Piece->IsOwn(block) && !this->Stopped &&
          !(visits.OnlyActive && !this->Blocks->HasActive(block));
      });
    for (const int block : own)
    {
      this->Piece->BeginVisit(block);
    }
    ForSpans(this->Threads, own.size(), 1,
      [&](std::size_t i, std::size_t, std::size_t)
      { this->VisitBlock(own[i], visits, OnThisThread()); });
    for (const int block : own)
    {
      this->Piece->EndVisit(block);
    }
    visited += ofColour.size();
    this->Piece->Exchange();
    goOn(visited);
  }
  this->AgreeOnStop();
  this->Piece->ShareCounts();
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
    int Counts[8];
    double TimeStep;
  };
  for (SweptRow& swept : rows)
  {
    HistoryRow& row = swept.Row;
    int* const counts[8] = { &row.ActiveVertices, &row.Merges, &row.Cuts, &row.Splits,
      &row.Collapses, &row.Flips, &row.Deletions, &row.DeletedGenus };
    Sums own;
    for (int i = 0; i < 8; ++i)
    {
      own.Counts[i] = *counts[i];
      *counts[i] = 0;
    }
    own.TimeStep = row.TimeStep;
    for (const Sums& ofRank : GatherValues(this->Sharers(), own))
    {
      for (int i = 0; i < 8; ++i)
      {
        *counts[i] += ofRank.Counts[i];
      }
      row.TimeStep = std::max(row.TimeStep, ofRank.TimeStep);
    }
    struct Changes
    {
      int Vertices;
      int EulerCharacteristic;
    };
    const Changes here{ swept.Vertices, swept.EulerCharacteristic };
    swept.Vertices = swept.EulerCharacteristic = 0;
    for (const Changes& ofRank : GatherValues(this->Sharers(), here))
    {
      swept.Vertices += ofRank.Vertices;
      swept.EulerCharacteristic += ofRank.EulerCharacteristic;
    }
    row.KineticEnergy = this->Piece->AddUp(swept.KineticEnergy);
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
  this->CountComponents();
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

void SurfaceEvolution::Implementation::Unite()
{
  if (this->IsInPieces())
  {
    this->Piece->Gather();
    this->MakeBlocks();
  }
}
}
