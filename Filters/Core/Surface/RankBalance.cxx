// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Blocks that go from rank to rank, so that all have as much to do: RankBlocks::Balance.

#include "Core/Common/RankLists.h"
#include "Core/Common/Spans.h"
#include "Core/Surface/RankBlocks.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace volumic
{
namespace
{
/** What has to be saved of a sweep, in looks at a vertex: about a millisecond, */
constexpr std::int64_t LeastGain = 3000;
/** and as many for each vertex that moves: to write, send and read all that is known of it. */
constexpr std::int64_t LooksToMove = 4;
}

std::vector<RankBlocks::Load> RankBlocks::LoadsOfBlocks(bool onlyActive, Executor& executor) const
{
  std::vector<Load> loads(this->Owners.size(), Load());
  ForSpans(executor, loads.size(), 1,
    [&](std::size_t b, std::size_t, std::size_t)
    {
      const int block = static_cast<int>(b);
      if (this->IsOwn(block))
      {
        loads[b] = { this->Blocks.WorkOf(block, onlyActive),
          static_cast<std::int64_t>(this->Blocks.ListOf(block).size()) };
      }
    });
  struct LoadOfBlock
  {
    int Block;
    Load Is;
  };
  std::vector<LoadOfBlock> own; // Most have no vertices.
  for (std::size_t block = 0; block < loads.size(); ++block)
  {
    if (loads[block].Vertices > 0)
    {
      own.push_back({ static_cast<int>(block), loads[block] });
    }
  }
  for (const LoadOfBlock& load : GatherListsOnAll(this->Ranks, own))
  {
    loads[load.Block] = load.Is;
  }
  return loads;
}

bool RankBlocks::Balance(bool onlyActive, Executor& executor)
{
  const int ranks = this->Ranks.NumberOfRanks();
  if (ranks == 1)
  {
    return false;
  }
  const std::vector<Load> loads = this->LoadsOfBlocks(onlyActive, executor);
  std::vector<int> owners = BalancedOwners(this->Blocks, loads, this->Owners, ranks);
  const std::int64_t gain = WorkOfSweep(loads, this->Owners, ranks) -
    WorkOfSweep(loads, owners, ranks);
  std::int64_t least = LeastGain;
  for (std::size_t block = 0; block < owners.size(); ++block)
  {
    // Ranks send at the same time.
    least += owners[block] != this->Owners[block] ? LooksToMove * loads[block].Vertices / ranks : 0;
  }
  if (gain < least)
  {
    return false;
  }
  this->MoveBlocks(std::move(owners));
  return true;
}

bool RankBlocks::IsNearMoved(int block, const std::vector<int>& before) const
{
  const auto hasMoved = [&](int b) { return this->Owners[b] != before[b]; };
  const std::vector<int> others = this->Blocks.NeighboursOf(block);
  return hasMoved(block) || std::any_of(others.begin(), others.end(), hasMoved);
}

void RankBlocks::MoveBlocks(std::vector<int> owners)
{
  const std::vector<int> before = this->Owners;
  this->SetOwners(std::move(owners));
  // What others may lack of the own vertices, and what this rank may not be told of any more.
  std::vector<int> own;
  std::vector<int> known;
  for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
  {
    if (this->IsNearMoved(block, before))
    {
      const std::vector<int> vertices = this->Blocks.VerticesOf(block);
      known.insert(known.end(), vertices.begin(), vertices.end());
      if (before[block] == this->Ranks.Rank())
      {
        own.insert(own.end(), vertices.begin(), vertices.end());
      }
    }
  }
  std::vector<Message> messages(static_cast<std::size_t>(this->Ranks.NumberOfRanks()));
  for (int rank = 0; rank < this->Ranks.NumberOfRanks(); ++rank)
  {
    if (rank != this->Ranks.Rank())
    {
      messages[rank] = this->LeaveBlocks(rank, before, own);
    }
  }
  for (const int v : known)
  {
    if (!this->IsNearOwn(this->State.Mesh.Position[v]))
    {
      this->State.Forget(v);
    }
  }
  for (const Message& message : this->Ranks.Exchange(std::move(messages)))
  {
    if (!message.empty())
    {
      this->TakeBlocks(message);
    }
  }
}

Message RankBlocks::LeaveBlocks(
  int rank, const std::vector<int>& before, const std::vector<int>& vertices)
{
  std::vector<int> blocks;
  for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
  {
    if (before[block] == this->Ranks.Rank() && this->Owners[block] == rank)
    {
      blocks.push_back(block);
    }
  }
  MessageWriter writer;
  writer.AddArray(blocks);
  for (const int block : blocks)
  {
    this->Blocks.Write(writer, block);
  }
  // Also those that it has: of the outermost ones it does not know the shape.
  std::vector<int> near;
  std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(near),
    [&](int v)
    {
      bool isNear = false;
      this->Blocks.VisitNear(this->State.Mesh.Position[v], this->Halo(),
        [&](int block) { isNear = isNear || this->Owners[block] == rank; });
      return isNear;
    });
  this->State.Write(writer, near);
  return writer.Take();
}

void RankBlocks::TakeBlocks(const Message& message)
{
  MessageReader reader(message);
  for (const int block : reader.TakeVector<int>())
  {
    this->Blocks.Read(reader, block);
  }
  this->Blocks.AddOthers(this->State.Read(reader));
}
}
