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
/** Vertices that are packed at a time. */
constexpr std::size_t PackedSpan = 1 << 16;

/** Of rings only the neighbours that there are: half of what they take. */
void SaveVertices(CheckedWriter& file, const SurfaceMesh& mesh, const std::vector<int>& vertices)
{
  std::vector<Vector> positions;
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t i = 0; i < vertices.size();)
  {
    positions.clear();
    counts.clear();
    items.clear();
    for (; i < vertices.size() && counts.size() < PackedSpan; ++i)
    {
      const Ring& ring = mesh.Rings[vertices[i]];
      positions.push_back(mesh.Position[vertices[i]]);
      counts.push_back(static_cast<std::uint8_t>(ring.Count));
      items.insert(items.end(), ring.Item, ring.Item + ring.Count);
    }
    file.PutList(positions);
    file.PutList(counts);
    file.PutList(items);
  }
}

void LoadVertices(CheckedReader& file, SurfaceMesh& mesh, const std::vector<int>& vertices)
{
  std::vector<Vector> positions;
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t i = 0; i < vertices.size();)
  {
    file.GetList(positions);
    file.GetList(counts);
    file.GetList(items);
    const int* next = items.data();
    for (std::size_t k = 0; k < counts.size(); ++k, ++i)
    {
      mesh.Position[vertices[i]] = positions[k];
      Ring& ring = mesh.Rings[vertices[i]];
      ring.Count = counts[k];
      std::copy(next, next + ring.Count, ring.Item);
      next += ring.Count;
    }
  }
}

std::vector<int> AliveOf(const SurfaceMesh& mesh)
{
  std::vector<int> alive;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (mesh.IsAlive(v))
    {
      alive.push_back(v);
    }
  }
  return alive;
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
  const std::vector<int> alive = AliveOf(s.Mesh);
  file.Put<std::uint64_t>(s.Mesh.Position.size());
  file.Put<int>(s.Mesh.NumberOfVertices());
  file.PutList(alive);
  SaveVertices(file, s.Mesh, alive);
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
  const auto places = file.Get<std::uint64_t>();
  const int vertices = file.Get<int>();
  std::vector<int> alive;
  file.GetList(alive);
  SurfaceMesh mesh;
  mesh.Remake(places, vertices);
  LoadVertices(file, mesh, alive);
  std::vector<int> free;
  file.GetList(free);
  mesh.CountOthers(static_cast<int>(free.size()));
  mesh.SetFreePlaces(std::move(free));
  s.Mesh = std::move(mesh);
}
}
