// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceAtRest.h"

#include "Core/Common/Select.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that are packed at a time. */
constexpr std::size_t PackedSpan = 1 << 16;

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
      const double square =
        SquaredDistance(VectorD(mesh.Position[v]), VectorD(mesh.Position[w])) / (length * length);
      NeedThat(square <= longest * longest, file);
      sum += square;
      count += 1.;
    }
  }
  NeedThat(sum <= mean * mean * count, file);
}

/** Of rings only the neighbours that there are: half of what they take. */
void SaveMesh(CheckedWriter& file, const SurfaceMesh& mesh)
{
  std::vector<int> alive;
  LargeVector<int> numberOf(mesh.Rings.size(), -1);
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (mesh.IsAlive(v))
    {
      numberOf[v] = static_cast<int>(alive.size());
      alive.push_back(v);
    }
  }
  file.Put<std::uint64_t>(alive.size());
  for (std::size_t first = 0; first < alive.size(); first += PackedSpan)
  {
    std::vector<Vector> positions;
    std::vector<std::uint8_t> counts;
    std::vector<int> items;
    for (std::size_t i = first; i < std::min(first + PackedSpan, alive.size()); ++i)
    {
      const Ring& ring = mesh.Rings[alive[i]];
      positions.push_back(mesh.Position[alive[i]]);
      counts.push_back(static_cast<std::uint8_t>(ring.Count));
      std::for_each(
        ring.Item, ring.Item + ring.Count, [&](int w) { items.push_back(numberOf[w]); });
    }
    file.PutList(positions);
    file.PutList(counts);
    file.PutList(items);
  }
}

void LoadMesh(CheckedReader& file, SurfaceMesh& mesh)
{
  const std::size_t n = file.GetCount(sizeof(Vector));
  mesh.Remake(n);
  std::vector<Vector> positions;
  std::vector<std::uint8_t> counts;
  std::vector<int> items;
  for (std::size_t v = 0; v < n;)
  {
    file.GetList(positions);
    file.GetList(counts);
    file.GetList(items);
    const auto wanted = std::accumulate(counts.begin(), counts.end(), std::size_t(0));
    NeedThat(!counts.empty() && counts.size() <= n - v && positions.size() == counts.size() &&
        items.size() == wanted && *std::max_element(counts.begin(), counts.end()) <= Ring::Capacity,
      file);
    const int* next = items.data();
    for (std::size_t k = 0; k < counts.size(); ++k, ++v)
    {
      const Vector& p = positions[k];
      NeedThat(std::isfinite(p.X) && std::isfinite(p.Y) && std::isfinite(p.Z), file);
      mesh.Position[v] = p;
      mesh.Rings[v].Count = counts[k];
      std::copy(next, next + counts[k], mesh.Rings[v].Item);
      next += counts[k];
    }
  }
  CheckRings(file, mesh);
}
}

void SurfaceAtRest::Save(CheckedWriter& file) const
{
  file.Put<std::uint64_t>(sizeof(HistoryRow));
  file.PutList(this->History.Rows);
  file.Put(this->Level);
  file.Put(this->Delta);
  file.Put(this->Unchecked);
  SaveMesh(file, this->Mesh);
}

void SurfaceAtRest::Load(CheckedReader& file)
{
  if (file.Get<std::uint64_t>() != sizeof(HistoryRow))
  {
    file.Refuse("was written by another version of Volumic");
  }
  file.GetList(this->History.Rows);
  this->Level = file.Get<int>();
  this->Delta = file.Get<float>();
  this->Unchecked = file.Get<int>();
  NeedThat(this->Delta > 0.f && std::isfinite(this->Delta), file);
  LoadMesh(file, this->Mesh);
  CheckLengths(file, this->Mesh, this->Delta);
}
}
