// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/VoxelPieces.h"

#include "Core/Common/RankLists.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace volumic
{
namespace
{
/** What comes at a time of some boxes: of about so many bytes, or a slice along z. */
std::vector<std::vector<VoxelBox>> RoundsOf(
  const std::vector<VoxelBox>& boxes, std::size_t bytes, std::size_t most)
{
  std::vector<std::vector<VoxelBox>> rounds;
  double room = 0.; // That the last round has left.
  for (const VoxelBox& box : boxes)
  {
    const double slice = static_cast<double>(bytes) * box.Length(0) * box.Length(1);
    for (int k = box.First[2]; !box.IsEmpty() && k < box.End[2];)
    {
      if (rounds.empty() || room < slice)
      {
        rounds.emplace_back();
        room = std::max(static_cast<double>(most), slice);
      }
      VoxelBox slices = box;
      slices.First[2] = k;
      k += static_cast<int>(std::min(room / slice, static_cast<double>(box.End[2] - k)));
      slices.End[2] = k;
      room -= slice * slices.Length(2);
      rounds.back().push_back(slices);
    }
  }
  return rounds;
}
}

VoxelPieces::VoxelPieces(Communicator& ranks, const VoxelBox& held)
  : Held(GatherValues(ranks, held))
{
}

VoxelBox VoxelPieces::Bounds() const
{
  VoxelBox bounds;
  for (const VoxelBox& box : this->Held)
  {
    bounds = bounds.With(box);
  }
  return bounds;
}

bool VoxelPieces::HoldAll(const VoxelBox& box) const
{
  std::vector<VoxelBox> rest = { box };
  for (const VoxelBox& held : this->Held)
  {
    rest = Without(rest, held);
  }
  return rest.empty();
}

std::vector<VoxelBox> VoxelPieces::OwnOf(int rank) const
{
  std::vector<VoxelBox> own = { this->HeldBy(rank) };
  own = Without(own, VoxelBox());
  for (int lower = 0; lower < rank; ++lower)
  {
    own = Without(own, this->HeldBy(lower));
  }
  return own;
}

std::vector<VoxelPieces::Delivery> VoxelPieces::DeliveriesFor(
  int rank, const std::vector<VoxelBox>& wanted) const
{
  std::vector<Delivery> deliveries;
  std::vector<VoxelBox> rest = wanted;
  const auto take = [&](int from)
  {
    const VoxelBox& held = this->HeldBy(from);
    for (const VoxelBox& box : rest)
    {
      const VoxelBox common = box.CommonWith(held);
      if (!common.IsEmpty())
      {
        deliveries.push_back({ from, common });
      }
    }
    rest = Without(rest, held);
  };
  take(rank);
  for (int from = 0; from < static_cast<int>(this->Held.size()) && !rest.empty(); ++from)
  {
    take(from);
  }
  return deliveries;
}

void VoxelPieces::Fetch(Communicator& ranks, const void* voxels, std::size_t bytes,
  const VoxelBox& wanted, void* fetched) const
{
  this->FetchInto(
    ranks, voxels, this->HeldBy(ranks.Rank()), bytes, { wanted }, wanted, fetched);
}

void VoxelPieces::FetchInto(Communicator& ranks, const void* voxels, const VoxelBox& layout,
  std::size_t bytes, const std::vector<VoxelBox>& wanted, const VoxelBox& place,
  void* fetched) const
{
  std::vector<std::vector<std::vector<VoxelBox>>> rounds; // By rank.
  std::size_t count = 0;
  for (const std::vector<VoxelBox>& boxes : GatherEachOnAll(ranks, wanted))
  {
    rounds.push_back(RoundsOf(boxes, bytes, this->BytesAtATime));
    count = std::max(count, rounds.back().size());
  }
  for (std::size_t n = 0; n < count; ++n)
  {
    std::vector<std::vector<VoxelBox>> round;
    for (std::vector<std::vector<VoxelBox>>& ofRank : rounds)
    {
      ofRank.resize(count); // Nothing past its last.
      round.push_back(std::move(ofRank[n]));
    }
    this->FetchOnce(ranks, static_cast<const char*>(voxels), layout, bytes, round, place,
      static_cast<char*>(fetched));
  }
}

void VoxelPieces::FetchOnce(Communicator& ranks, const char* voxels, const VoxelBox& layout,
  std::size_t bytes, const std::vector<std::vector<VoxelBox>>& wanted, const VoxelBox& place,
  char* fetched) const
{
  const int own = ranks.Rank();
  std::vector<Message> messages(this->Held.size());
  std::vector<int> partners = { own };
  for (int to = 0; to < ranks.NumberOfRanks(); ++to)
  {
    Message& message = messages[static_cast<std::size_t>(to)];
    for (const Delivery& delivery : this->DeliveriesFor(to, wanted[static_cast<std::size_t>(to)]))
    {
      if (to == own && delivery.From != own)
      {
        partners.push_back(delivery.From);
      }
      if (to == own || delivery.From != own)
      {
        continue;
      }
      partners.push_back(to);
      ForRowsOf(delivery.Box, layout,
        [&](std::int64_t first, std::int64_t count)
        {
          const char* row = voxels + static_cast<std::size_t>(first) * bytes;
          message.insert(message.end(), row, row + static_cast<std::size_t>(count) * bytes);
        });
    }
  }
  std::sort(partners.begin(), partners.end());
  partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
  messages = ranks.Exchange(std::move(messages), partners);

  std::vector<std::size_t> read(messages.size(), 0);
  for (const Delivery& delivery : this->DeliveriesFor(own, wanted[static_cast<std::size_t>(own)]))
  {
    const auto from = static_cast<std::size_t>(delivery.From);
    int row = 0; // of the delivery
    ForRowsOf(delivery.Box, place,
      [&](std::int64_t first, std::int64_t count)
      {
        const int j = delivery.Box.First[1] + row % delivery.Box.Length(1);
        const int k = delivery.Box.First[2] + row / delivery.Box.Length(1);
        ++row;
        const auto size = static_cast<std::size_t>(count) * bytes;
        const char* source = delivery.From == own
          ? voxels + static_cast<std::size_t>(layout.NumberOf(delivery.Box.First[0], j, k)) * bytes
          : messages[from].data() + read[from];
        read[from] += size;
        char* const target = fetched + static_cast<std::size_t>(first) * bytes;
        if (source != target) // Where what is held lies in the same room.
        {
          std::memcpy(target, source, size);
        }
      });
  }
}
}
