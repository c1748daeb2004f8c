// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RankBlocks.h"

#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace volumic
{
RankBlocks::RankBlocks(SurfaceState& state, SurfaceBlocks& blocks, Communicator& ranks)
  : State(state)
  , Blocks(blocks)
  , Ranks(ranks)
  , Owners(static_cast<std::size_t>(blocks.NumberOfBlocks()), 0)
  , IsAtBorder(this->Owners.size(), 0)
  , Awaited(this->Owners.size(), 0)
  , Partners(1, ranks.Rank())
  , Touched(static_cast<std::size_t>(ranks.NumberOfRanks()))
{
}

void RankBlocks::ChooseOwners(const SurfaceMesh& mesh, const std::vector<int>& own)
{
  std::vector<int> counts(static_cast<std::size_t>(this->Blocks.NumberOfBlocks()), 0);
  for (const int v : own)
  {
    ++counts[this->Blocks.BlockAt(mesh.Position[v])];
  }
  struct BlockCount
  {
    int Block;
    int Vertices;
  };
  std::vector<BlockCount> some; // Most blocks have no vertices.
  for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
  {
    if (counts[block] > 0)
    {
      some.push_back({ block, std::exchange(counts[block], 0) });
    }
  }
  for (const BlockCount& count : GatherListsOnAll(this->Ranks, some))
  {
    counts[count.Block] += count.Vertices;
  }
  this->SetOwners(
    ChooseOwners(this->Blocks.GetFrame(), counts, this->Ranks.NumberOfRanks()));
}

void RankBlocks::SetOwners(std::vector<int> owners)
{
  this->Owners = std::move(owners);
  this->IsAtBorder.assign(this->Owners.size(), 0);
  this->Partners.assign(1, this->Ranks.Rank());
  for (int block = 0; block < static_cast<int>(this->Owners.size()); ++block)
  {
    if (!this->IsOwn(block))
    {
      continue;
    }
    for (const int other : this->Blocks.NeighboursOf(block))
    {
      if (!this->IsOwn(other))
      {
        this->IsAtBorder[block] = 1;
        this->Partners.push_back(this->OwnerOf(other));
      }
    }
  }
  std::sort(this->Partners.begin(), this->Partners.end());
  this->Partners.erase(
    std::unique(this->Partners.begin(), this->Partners.end()), this->Partners.end());
  this->FindAwaited();
}

void RankBlocks::FindAwaited()
{
  this->Awaited = this->IsAtBorder;
  std::vector<char> isLater(this->Owners.size(), 0); // Or of the same colour.
  for (int colour = SurfaceBlocks::Colours - 1; colour > 0; --colour)
  {
    const std::vector<int>& ofColour = this->Blocks.ByColour()[colour];
    for (const int block : ofColour)
    {
      isLater[block] = 1;
    }
    for (const int block : ofColour)
    {
      if (this->Awaited[block])
      {
        for (const int other : this->Blocks.NeighboursOf(block))
        {
          this->Awaited[other] |= this->IsOwn(other) && !isLater[other];
        }
      }
    }
  }
}

void RankBlocks::Scatter(const SurfaceMesh& mesh, const std::vector<int>& own,
  const Vector& low, const Vector& high)
{
  std::size_t ends = 0; // Of edges.
  for (const int v : own)
  {
    ends += static_cast<std::size_t>(mesh.Rings[v].Count);
    this->CollectNear(mesh.Position[v], v, -1);
  }
  using Sizes = std::array<std::size_t, 3>; // Vertices and ends of each rank, places of rank 0.
  const std::vector<Sizes> all =
    GatherValues(this->Ranks, Sizes{ own.size(), ends, mesh.Rings.size() });
  const auto sumOf = [&all](std::size_t which)
  {
    return std::accumulate(all.begin(), all.end(), std::size_t(0),
      [which](std::size_t sum, const Sizes& sizes) { return sum + sizes[which]; });
  };
  const std::size_t places = all.front()[2];
  this->NumberOfVertices = static_cast<int>(sumOf(0));
  this->EulerCharacteristic = this->NumberOfVertices - static_cast<int>(sumOf(1) / 6);
  this->Blocks.ForgetVertices();
  this->State.Remake(places, this->NumberOfVertices, low, high);
  this->State.EulerCharacteristic = this->EulerCharacteristic;
  std::vector<int> here;
  const int rank = this->Ranks.Rank();
  const int count = this->Ranks.NumberOfRanks();
  for (int turn = 0; turn < count; ++turn)
  {
    // To one rank at a time: all messages together are as much as the piece.
    const int to = (rank + turn) % count;
    MessageWriter writer;
    SurfaceState::WriteMesh(mesh, writer, std::exchange(this->Touched[to], {}));
    const Message message =
      Trade(this->Ranks, to, (rank + count - turn) % count, writer.Take());
    MessageReader reader(message);
    const std::vector<int> come = this->State.ReadMesh(reader);
    here.insert(here.end(), come.begin(), come.end());
  }
  std::sort(here.begin(), here.end());
  this->Blocks.Take(here);
}

void RankBlocks::Append(const IndexedSurface& surface, Executor& executor)
{
  SurfaceState& s = this->State;
  SurfaceMesh added;
  added.Append(surface, executor);
  const int first = s.AddUnusedPlaces(added.Size(), executor).Next;
  const std::vector<int> near = SelectIndices(executor, added.Rings.size(),
    [&](std::size_t v) { return this->IsNearOwn(added.Position[v]); });
  const std::vector<int> here = s.AddPiece(added, first, near, executor);
  this->Blocks.Take(here);
  this->Blocks.ExpectMoves(here);
  std::vector<int> inside = SelectIndices(executor, here.size(), // With all their neighbours.
    [&](std::size_t i)
    {
      const Ring& ring = s.Mesh.Rings[here[i]];
      return std::all_of(
        ring.Item, ring.Item + ring.Count, [&s](int w) { return s.Mesh.IsAlive(w); });
    });
  for (int& v : inside)
  {
    v = here[v];
  }
  s.UpdateShape(inside, executor);
  s.Mesh.CountOthers(added.Size());
  s.EulerCharacteristic += added.CountEulerCharacteristic(executor);
  this->NumberOfVertices = s.Mesh.NumberOfVertices();
  this->EulerCharacteristic = s.EulerCharacteristic;
}

VoxelBox RankBlocks::RowsOf(const LevelImage& image) const
{
  // Blocks are owned in boxes of whole rows of them.
  const SurfaceBlocks::Frame& frame = this->Blocks.GetFrame();
  const std::array<int, 3> stride = { 1, frame.Size[0], frame.Size[0] * frame.Size[1] };
  const auto placeOf = [&](int block, int axis) { return block / stride[axis] % frame.Size[axis]; };
  std::array<std::vector<char>, 3> isOwn; // By place along an axis.
  for (int axis = 1; axis < 3; ++axis)
  {
    isOwn[axis].assign(static_cast<std::size_t>(frame.Size[axis]), 0);
    for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
    {
      isOwn[axis][placeOf(block, axis)] |= this->IsOwn(block);
    }
  }
  VoxelBox rows;
  rows.End[0] = image.Size[0];
  for (int axis = 1; axis < 3; ++axis)
  {
    bool hasBegun = false;
    for (int i = 0; i < image.Size[axis]; ++i)
    {
      Vector position = frame.Low;
      (axis == 1 ? position.Y : position.Z) = static_cast<float>(i * image.Step[axis]);
      if (isOwn[axis][placeOf(this->Blocks.BlockAt(position), axis)])
      {
        rows.First[axis] = hasBegun ? rows.First[axis] : i;
        rows.End[axis] = i + 1;
        hasBegun = true;
      }
    }
  }
  return rows;
}

bool RankBlocks::ShareCounts(bool isHere)
{
  struct Changes
  {
    int Vertices;
    int Characteristic;
    bool IsThere;
  };
  bool isAnywhere = false;
  SurfaceState& s = this->State;
  const std::vector<Changes> all = GatherValues(this->Ranks,
    Changes{ s.Mesh.NumberOfVertices() - this->NumberOfVertices,
      s.EulerCharacteristic - this->EulerCharacteristic, isHere });
  for (const Changes& changes : all)
  {
    isAnywhere = isAnywhere || changes.IsThere;
    this->NumberOfVertices += changes.Vertices;
    this->EulerCharacteristic += changes.Characteristic;
  }
  s.Mesh.CountOthers(this->NumberOfVertices - s.Mesh.NumberOfVertices());
  s.EulerCharacteristic = this->EulerCharacteristic;
  return isAnywhere;
}

void RankBlocks::AddPlaces(Executor& executor)
{
  std::vector<int> counts(this->Owners.size(), 0);
  ForSpans(executor, counts.size(), 1,
    [&](std::size_t b, std::size_t, std::size_t)
    {
      const int block = static_cast<int>(b);
      counts[b] = this->IsOwn(block) ? this->Blocks.MissingPlaces(block) : 0;
    });
  struct Places
  {
    int Block;
    int Count;
  };
  std::vector<Places> missing; // Of few blocks.
  for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
  {
    if (counts[block] > 0)
    {
      missing.push_back({ block, counts[block] });
    }
  }
  for (const Places& ofBlock : GatherListsOnAll(this->Ranks, missing))
  {
    counts[ofBlock.Block] = ofBlock.Count;
  }
  this->Blocks.AddPlaces(counts, executor);
}

std::vector<double> RankBlocks::AddUp(const std::vector<std::vector<double>>& lists)
{
  // Most blocks have no vertices, and nothing to add.
  std::vector<int> own;
  for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
  {
    if (this->IsOwn(block) &&
      std::any_of(lists.begin(), lists.end(), [block](auto& list) { return list[block] != 0.; }))
    {
      own.push_back(block);
    }
  }
  MessageWriter writer;
  writer.AddArray(own);
  for (const std::vector<double>& list : lists)
  {
    for (const int block : own)
    {
      writer.Add(list[block]);
    }
  }
  const std::vector<Message> messages = this->Ranks.Gather(writer.Take());
  std::vector<MessageReader> readers(messages.begin(), messages.end());
  std::vector<std::vector<int>> blocks;
  for (MessageReader& reader : readers)
  {
    blocks.push_back(reader.TakeVector<int>());
  }
  std::vector<double> all(this->Owners.size(), 0.); // Of a list.
  std::vector<double> sums;
  for (std::size_t list = 0; list < lists.size(); ++list)
  {
    for (std::size_t rank = 0; rank < readers.size(); ++rank)
    {
      for (const int block : blocks[rank])
      {
        all[block] = readers[rank].Take<double>();
      }
    }
    sums.push_back(std::accumulate(all.begin(), all.end(), 0.));
  }
  return BroadcastList(this->Ranks, sums);
}
}
