// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Blocks that go from rank to rank, so that all have as much to do, RankBlocks::Balance, and what a
// rank does while it would wait for others: RankBlocks::WaitsOfSweep.

#include "Core/Common/FreeMemory.h"
#include "Core/Common/RankLists.h"
#include "Core/Common/Spans.h"
#include "Core/Surface/RankBlocks.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** What has to be saved of a sweep, in looks at a vertex: about a millisecond, */
constexpr std::int64_t LeastGain = 3000;
/** and as many for each vertex that moves: to write, send and read all that is known of it. */
constexpr std::int64_t LooksToMove = 4;
/** Of those that move: what is on the way takes memory beside them. */
constexpr std::size_t VerticesAtATime = std::size_t(1) << 15;
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

RankBlocks::WorkByColour RankBlocks::WaitsOf(int rank, const std::vector<Turns>& ofRanks)
{
  WorkByColour waits{};
  std::vector<std::int64_t> now(ofRanks.size(), 0);
  for (std::size_t colour = 0; colour < waits.size(); ++colour)
  {
    for (std::size_t r = 0; r < ofRanks.size(); ++r)
    {
      now[r] += ofRanks[r].Awaited[colour];
    }
    const std::vector<std::int64_t> there = now;
    for (std::size_t r = 0; r < ofRanks.size(); ++r)
    {
      for (const int partner : ofRanks[r].Partners)
      {
        now[r] = std::max(now[r], there[partner]);
      }
    }
    waits[colour] = now[rank] - there[rank];
  }
  return waits;
}

RankBlocks::WorkByColour RankBlocks::WaitsOfSweep(bool onlyActive) const
{
  WorkByColour awaited{};
  for (int colour = 0; colour < SurfaceBlocks::Colours; ++colour)
  {
    for (const int block : this->Blocks.ByColour()[colour])
    {
      awaited[colour] += this->IsAwaited(block) ? this->Blocks.WorkOf(block, onlyActive) : 0;
    }
  }
  MessageWriter writer;
  writer.Add(awaited);
  writer.AddArray(this->Partners);
  std::vector<Turns> ofRanks;
  for (const Message& message : this->Ranks.GatherOnAll(writer.Take()))
  {
    MessageReader reader(message);
    ofRanks.emplace_back();
    ofRanks.back().Awaited = reader.Take<WorkByColour>();
    reader.TakeArray(ofRanks.back().Partners);
  }
  return WaitsOf(this->Ranks.Rank(), ofRanks);
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
  this->SendBlocks(before);
  this->SendVertices(own);
  known.erase(std::remove_if(known.begin(), known.end(),
                [this](int v) { return this->IsNearOwn(this->State.Mesh.Position[v]); }),
    known.end());
  for (const int v : known)
  {
    this->State.Forget(v);
  }
  this->State.GiveBack(std::move(known));
  GiveBackFreeMemory(); // Of the messages.
}

void RankBlocks::SendBlocks(const std::vector<int>& before)
{
  std::vector<Message> messages(static_cast<std::size_t>(this->Ranks.NumberOfRanks()));
  for (int rank = 0; rank < this->Ranks.NumberOfRanks(); ++rank)
  {
    MessageWriter writer;
    for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
    {
      if (rank != this->Ranks.Rank() && before[block] == this->Ranks.Rank() &&
        this->OwnerOf(block) == rank)
      {
        writer.Add(block);
        this->Blocks.Write(writer, block);
      }
    }
    messages[rank] = writer.Take();
  }
  for (const Message& message : this->Ranks.Exchange(std::move(messages)))
  {
    for (MessageReader reader(message); !reader.IsAtEnd();)
    {
      const int block = reader.Take<int>();
      this->Blocks.Read(reader, block);
    }
  }
}

void RankBlocks::SendVertices(const std::vector<int>& vertices)
{
  // Also those that a rank has: of the outermost ones it does not know the shape.
  for (const int v : vertices)
  {
    this->CollectNear(this->State.Mesh.Position[v], v, this->Ranks.Rank());
  }
  std::size_t most = 0;
  for (const std::vector<int>& touched : this->Touched)
  {
    most = std::max(most, touched.size());
  }
  const std::vector<std::size_t> ofRanks = GatherValues(this->Ranks, most);
  most = *std::max_element(ofRanks.begin(), ofRanks.end());
  for (std::size_t begin = 0; begin < most; begin += VerticesAtATime)
  {
    std::vector<Message> messages(this->Touched.size());
    for (std::size_t rank = 0; rank < messages.size(); ++rank)
    {
      const std::vector<int>& touched = this->Touched[rank];
      if (begin < touched.size())
      {
        const auto first = touched.begin() + static_cast<std::ptrdiff_t>(begin);
        const std::size_t count = std::min(touched.size() - begin, VerticesAtATime);
        MessageWriter writer;
        this->State.Write(writer, { first, first + static_cast<std::ptrdiff_t>(count) });
        messages[rank] = writer.Take();
      }
    }
    for (const Message& message : this->Ranks.Exchange(std::move(messages)))
    {
      if (!message.empty())
      {
        MessageReader reader(message);
        this->Blocks.AddOthers(this->State.Read(reader));
      }
    }
  }
  for (std::vector<int>& touched : this->Touched)
  {
    touched = std::vector<int>();
  }
}
}
