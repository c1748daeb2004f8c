// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
// A division lays grid, order, shapes and pairs anew: where a surface rests, what is to come
// depends on the places of its vertices, on their rings, from the first neighbour on, and on the
// numbers that new ones will get, which decide where positions tie.

namespace
{
/** Rings that are packed at a time. */
constexpr std::size_t PackedSpan = 1 << 16;

/** Only the neighbours that there are: half of what the rings take. */
void SaveRings(CheckedWriter& file, const decltype(SurfaceMesh::Rings)& rings)
{
  file.Put<std::uint64_t>(rings.size());
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t v = 0; v < rings.size();)
  {
    counts.clear();
    items.clear();
    for (; v < rings.size() && counts.size() < PackedSpan; ++v)
    {
      counts.push_back(static_cast<std::uint8_t>(rings[v].Count));
      items.insert(items.end(), rings[v].Item, rings[v].Item + rings[v].Count);
    }
    file.PutList(counts);
    file.PutList(items);
  }
}

void LoadRings(CheckedReader& file, decltype(SurfaceMesh::Rings)& rings)
{
  rings.resize(file.Get<std::uint64_t>());
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t v = 0; v < rings.size();)
  {
    file.GetList(counts);
    file.GetList(items);
    const int* next = items.data();
    for (const std::uint8_t count : counts)
    {
      Ring& ring = rings[v++];
      ring.Count = count;
      std::copy(next, next + count, ring.Item);
      next += count;
    }
  }
}
}

void SurfaceEvolution::Save(CheckedWriter& file) const
{
  const Implementation& self = *this->Self;
  const SurfaceState& s = self.State;
  file.Put<std::uint64_t>(sizeof(HistoryRow));
  file.PutList(self.Rows);
  file.Put(self.Level);
  file.Put(self.LastIterations);
  file.Put(self.LastLost);
  file.Put(self.Preparing);
  file.Put(self.SinceEvolved);
  file.Put(self.Unchecked);
  file.Put(s.Sizing.OfLevel());
  file.PutList(s.Mesh.Position);
  SaveRings(file, s.Mesh.Rings);
  file.PutList(s.Mesh.FreePlaces());
}

void SurfaceEvolution::Load(CheckedReader& file)
{
  Implementation& self = *this->Self;
  SurfaceState& s = self.State;
  if (file.Get<std::uint64_t>() != sizeof(HistoryRow))
  {
    file.Refuse("was written by another version of Volumic");
  }
  file.GetList(self.Rows);
  self.Level = file.Get<int>();
  self.LastIterations = file.Get<int>();
  self.LastLost = file.Get<LostParts>();
  self.Preparing = file.Get<HistoryRow>();
  self.SinceEvolved = file.Get<EditCounts>();
  self.Unchecked = file.Get<int>();
  s.Sizing = SizingField(file.Get<float>());
  file.GetList(s.Mesh.Position);
  LoadRings(file, s.Mesh.Rings);
  std::vector<int> places;
  file.GetList(places);
  s.Mesh.SetFreePlaces(std::move(places));
}
}
