// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
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

/** The vertices without the places between them; of rings only the neighbours that there are. */
void SaveVertices(CheckedWriter& file, const SurfaceMesh& mesh)
{
  std::vector<int> number(mesh.Rings.size());
  int next = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    number[v] = mesh.IsAlive(v) ? next++ : NoVertex;
  }
  std::vector<Vector> positions;
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  const auto save = [&]
  {
    file.PutList(positions);
    file.PutList(counts);
    file.PutList(items);
    positions.clear();
    counts.clear();
    items.clear();
  };
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    if (ring.Count > 0)
    {
      positions.push_back(mesh.Position[v]);
      counts.push_back(static_cast<std::uint8_t>(ring.Count));
      std::transform(ring.Item, ring.Item + ring.Count, std::back_inserter(items),
        [&number](int w) { return number[w]; });
    }
    if (counts.size() == PackedSpan)
    {
      save();
    }
  }
  if (!counts.empty())
  {
    save();
  }
}

/** The signature of a file shows no damage, but whoever made it can sign anything. */
void NeedThat(bool isSo, const CheckedReader& file)
{
  if (!isSo)
  {
    file.Refuse("is damaged: what it holds is no surface");
  }
}

/** Refuses rings that lead elsewhere than to vertices, or do not lead back. */
void CheckRings(const CheckedReader& file, const SurfaceMesh& mesh)
{
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    NeedThat(ring.Count >= 3, file);
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      NeedThat(w >= 0 && w < mesh.Size() && w != v && ring.Find(w) == i, file);
      const int back = mesh.Rings[w].Find(v);
      NeedThat(back >= 0 && mesh.Rings[w].Previous(back) == ring.Next(i), file);
    }
  }
}

/** Refuses edges so long that cutting them up would never end. @param length the level's */
void CheckLengths(const CheckedReader& file, const SurfaceMesh& mesh, double length)
{
  // More than any grading makes them.
  constexpr double longest = 1000.;
  constexpr double mean = 64.;
  double sum = 0.;
  double count = 0.;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      const double square = SquaredDistance(VectorD(mesh.Position[v]), VectorD(mesh.Position[w])) /
        (length * length);
      NeedThat(square <= longest * longest, file);
      sum += square;
      count += 1.;
    }
  }
  NeedThat(sum <= mean * mean * count, file);
}

void LoadVertices(CheckedReader& file, SurfaceMesh& mesh)
{
  std::vector<Vector> positions;
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t i = 0; i < mesh.Rings.size();)
  {
    file.GetList(positions);
    file.GetList(counts);
    file.GetList(items);
    const auto wanted = std::accumulate(counts.begin(), counts.end(), std::size_t(0));
    NeedThat(!counts.empty() && counts.size() <= mesh.Rings.size() - i &&
        positions.size() == counts.size() && items.size() == wanted &&
        *std::max_element(counts.begin(), counts.end()) <= Ring::Capacity,
      file);
    const int* next = items.data();
    for (std::size_t k = 0; k < counts.size(); ++k, ++i)
    {
      const Vector& p = positions[k];
      NeedThat(std::isfinite(p.X) && std::isfinite(p.Y) && std::isfinite(p.Z), file);
      mesh.Position[i] = p;
      Ring& ring = mesh.Rings[i];
      ring.Count = counts[k];
      std::copy(next, next + ring.Count, ring.Item);
      next += ring.Count;
    }
  }
  CheckRings(file, mesh);
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
  file.Put<int>(s.Mesh.NumberOfVertices());
  SaveVertices(file, s.Mesh);
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
  const auto length = file.Get<float>();
  NeedThat(length > 0.f && std::isfinite(length), file);
  s.Sizing = SizingField(length);
  const int vertices = file.Get<int>();
  NeedThat(vertices >= 0, file);
  // A position and the number of its neighbours.
  file.Need(static_cast<std::uint64_t>(vertices), sizeof(Vector) + 1);
  SurfaceMesh mesh;
  mesh.Remake(static_cast<std::size_t>(vertices));
  LoadVertices(file, mesh);
  CheckLengths(file, mesh, length);
  s.Mesh = std::move(mesh);
}
}
