// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What ranks tell each other after visits: RankBlocks::Exchange.

#include "Core/Surface/RankBlocks.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace volumic
{
void RankBlocks::CollectNear(const Vector& position, int v, int exceptFor)
{
  this->Blocks.VisitNear(position, this->Halo(),
    [&](int block)
    {
      const int owner = this->OwnerOf(block);
      std::vector<int>& touched = this->Touched[owner];
      if (owner != exceptFor && (touched.empty() || touched.back() != v))
      {
        touched.push_back(v);
      }
    });
}

bool RankBlocks::IsNearOwn(const Vector& position) const
{
  bool isNear = false;
  this->Blocks.VisitNear(
    position, this->Halo(), [&](int block) { isNear = isNear || this->IsOwn(block); });
  return isNear;
}

std::vector<int> RankBlocks::BorderOf(int block) const
{
  std::vector<int> vertices;
  if (!this->IsAtBorder[block])
  {
    return vertices;
  }
  // Only blocks beside this one are so near what its visit writes.
  std::optional<Box> ofOthers;
  for (const int other : this->Blocks.NeighboursOf(block))
  {
    if (!this->IsOwn(other))
    {
      const Box box = this->Blocks.BoxOf(other).Grown(this->Halo());
      ofOthers = ofOthers ? ofOthers->With(box) : box;
    }
  }
  const Box written = this->Blocks.BoxOf(block).Grown(
    SurfaceBlocks::WrittenInDelta * this->State.Sizing.Largest());
  const Box border = written.Within(*ofOthers);
  this->State.Grid.VisitBox(border.Low, border.High,
    [&](int v)
    {
      if (border.Contains(this->State.Mesh.Position[v]))
      {
        vertices.push_back(v);
      }
    });
  return vertices;
}

void RankBlocks::BeginVisits(const std::vector<int>& blocks)
{
  SurfaceState& s = this->State;
  this->Known = {};
  for (const int block : blocks)
  {
    for (const int v : this->BorderOf(block))
    {
      this->Known.Vertices.push_back(v);
      this->Known.Positions.push_back(s.Mesh.Position[v]);
    }
  }
  this->Known.Hashes = s.HashesOf(this->Known.Vertices);
  for (const int v : this->Known.Vertices)
  {
    s.Marks[v] |= IsKnown;
  }
}

void RankBlocks::EndVisits(const std::vector<int>& blocks)
{
  SurfaceState& s = this->State;
  const int own = this->Ranks.Rank();
  for (const int block : blocks)
  {
    for (const int v : this->BorderOf(block))
    {
      if (!(s.Marks[v] & IsKnown))
      {
        this->CollectNear(s.Mesh.Position[v], v, own); // New here, or edited.
      }
    }
  }
  const std::vector<int>& known = this->Known.Vertices;
  for (const int v : known)
  {
    s.Marks[v] &= static_cast<std::uint8_t>(~IsKnown);
  }
  const std::vector<std::uint64_t> hashes = s.HashesOf(known);
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const int v = known[i];
    if (!s.Mesh.IsAlive(v) || hashes[i] != this->Known.Hashes[i])
    {
      this->CollectNear(this->Known.Positions[i], v, own); // Who had it must be told, too.
      this->CollectNear(s.Mesh.Position[v], v, own);
    }
  }
}

void RankBlocks::Exchange()
{
  std::vector<Message> messages(this->Touched.size());
  for (const int rank : this->Partners)
  {
    std::vector<int>& touched = this->Touched[rank];
    if (rank != this->Ranks.Rank())
    {
      std::sort(touched.begin(), touched.end());
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
      const auto alive = std::stable_partition(
        touched.begin(), touched.end(), [this](int v) { return !this->State.Mesh.IsAlive(v); });
      std::vector<Removed> removed;
      std::for_each(touched.begin(), alive,
        [&](int v) { removed.push_back({ v, this->State.Block[v] }); });
      MessageWriter writer;
      writer.AddArray(removed);
      this->State.Write(writer, { alive, touched.end() });
      messages[rank] = writer.Take();
    }
    touched.clear();
  }
  const std::vector<Message> received =
    this->Ranks.Exchange(std::move(messages), this->Partners);
  for (const int rank : this->Partners)
  {
    if (rank != this->Ranks.Rank())
    {
      MessageReader reader(received[rank]);
      for (const Removed& removed : reader.TakeVector<Removed>())
      {
        // Perhaps it had come to an own block, and was never heard of here.
        if (removed.Block != NoBlock && this->IsOwn(removed.Block))
        {
          this->Blocks.GiveBack(removed.Block, removed.Vertex);
        }
        this->State.Forget(removed.Vertex);
      }
      // What has left the halo would not be told of any more.
      std::vector<int> come = this->State.Read(reader);
      const auto near = std::stable_partition(come.begin(), come.end(),
        [this](int v) { return this->IsNearOwn(this->State.Mesh.Position[v]); });
      std::for_each(near, come.end(), [this](int v) { this->State.Forget(v); });
      come.erase(near, come.end());
      this->Blocks.AddOthers(come);
    }
  }
}
}
