// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/VoxelPieces.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace volumic
{
namespace
{
/** How many slices of a box along z come at a time. */
int SlicesAtATime(const VoxelBox& box, std::size_t bytes, std::size_t most)
{
  const double slice = static_cast<double>(bytes) * box.Length(0) * box.Length(1);
  return static_cast<int>(std::clamp(static_cast<double>(most) / slice, 1.0, 1e6));
}

/** The n-th of such rounds; nothing past the last. */
VoxelBox SlicesOfRound(const VoxelBox& box, std::size_t bytes, std::size_t most, int n)
{
  if (box.IsEmpty())
  {
    return box;
  }
  const int slices = SlicesAtATime(box, bytes, most);
  VoxelBox round = box;
  round.First[2] = std::min(box.First[2] + n * slices, box.End[2]);
  round.End[2] = std::min(round.First[2] + slices, box.End[2]);
  return round;
}

int NumberOfRounds(const VoxelBox& box, std::size_t bytes, std::size_t most)
{
  const int slices = box.IsEmpty() ? 1 : SlicesAtATime(box, bytes, most);
  return box.IsEmpty() ? 0 : (box.Length(2) + slices - 1) / slices;
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
  int rank, const VoxelBox& wanted) const
{
  std::vector<Delivery> deliveries;
  std::vector<VoxelBox> rest = { wanted };
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
  this->FetchInto(ranks, voxels, bytes, wanted, wanted, fetched);
}

void VoxelPieces::FetchInto(Communicator& ranks, const void* voxels, std::size_t bytes,
  const VoxelBox& wanted, const VoxelBox& place, void* fetched) const
{
  const std::vector<VoxelBox> all = GatherValues(ranks, wanted);
  int count = 0;
  for (const VoxelBox& box : all)
  {
    count = std::max(count, NumberOfRounds(box, bytes, this->BytesAtATime));
  }
  for (int n = 0; n < count; ++n)
  {
    std::vector<VoxelBox> round;
    for (const VoxelBox& box : all)
    {
      round.push_back(SlicesOfRound(box, bytes, this->BytesAtATime, n));
    }
    this->FetchOnce(ranks, static_cast<const char*>(voxels), bytes, round, place,
      static_cast<char*>(fetched));
  }
}

void VoxelPieces::FetchOnce(Communicator& ranks, const char* voxels, std::size_t bytes,
  const std::vector<VoxelBox>& wanted, const VoxelBox& place, char* fetched) const
{
  const int own = ranks.Rank();
  const VoxelBox& held = this->HeldBy(own);
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
      message.reserve(message.size() + static_cast<std::size_t>(delivery.Box.Count()) * bytes);
      ForRowsOf(delivery.Box, held,
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
          ? voxels + static_cast<std::size_t>(held.NumberOf(delivery.Box.First[0], j, k)) * bytes
          : messages[from].data() + read[from];
        read[from] += size;
        std::memcpy(fetched + static_cast<std::size_t>(first) * bytes, source, size);
      });
  }
}
}
