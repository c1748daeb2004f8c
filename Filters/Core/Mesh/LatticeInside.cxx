// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LatticeInside.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/**
 * What the lattice is set off by, in pitches, so that rows hit no corner of a surface on round
 * numbers: sqrt 2 - 1, (3 - sqrt 5) / 2 and sqrt 5 - 2.
 */
constexpr double Offset[3] = { 0.4142135623, 0.3819660113, 0.2360679775 };
}

LatticeInside::LatticeInside(const IndexedSurface& surface, double pitch) : Pitch(pitch)
{
  const Bounds bounds = Bounds::Of(surface);
  for (int k = 0; k < 3; ++k)
  {
    this->Origin[k] = bounds.Low[k] - (1. + Offset[k]) * pitch;
    this->Count[k] =
      static_cast<std::int64_t>(std::ceil((bounds.High[k] - this->Origin[k]) / pitch)) + 2;
  }
  this->Words = (this->Count[0] + WordSize - 1) / WordSize;
  this->Bits.assign(static_cast<std::size_t>(2 * LayersKept * this->Count[1] * this->Words), 0);
  for (const int kind : { 0, 1 })
  {
    const RowGrid rows = { {}, this->Count, this->Origin, pitch, 0.5 * kind };
    for (const Triangle& t : surface.Triangles)
    {
      rows.AddCrossings({ surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]] },
        this->Crossings[kind]);
    }
    std::sort(this->Crossings[kind].begin(), this->Crossings[kind].end());
  }
}

void LatticeInside::Fill(std::int64_t k)
{
  for (int kind : { 0, 1 })
  {
    const auto begin = static_cast<std::ptrdiff_t>(this->PlaceOfWord(kind, 0, k, 0));
    std::fill_n(this->Bits.begin() + begin, this->Count[1] * this->Words, std::uint64_t(0));
    const std::vector<RowGrid::Crossing>& crossings = this->Crossings[kind];
    const double start = this->PlaceOf({ kind, kind, kind })[0];
    int winding = 0;
    for (std::size_t& n = this->Next[kind];
         n < crossings.size() && crossings[n].Row < (k + 1) * this->Count[1]; ++n)
    {
      winding += crossings[n].Where.Winding;
      if (n + 1 == crossings.size() || crossings[n + 1].Row != crossings[n].Row)
      {
        winding = 0;
        continue;
      }
      if (winding < 1)
      {
        continue;
      }
      const auto from =
        static_cast<std::int64_t>(std::ceil((crossings[n].Where.X - start) / this->Pitch));
      const auto to =
        static_cast<std::int64_t>(std::ceil((crossings[n + 1].Where.X - start) / this->Pitch));
      for (std::int64_t i = from; i < to; ++i)
      {
        const std::int64_t j = crossings[n].Row - k * this->Count[1];
        this->Bits[this->PlaceOfWord(kind, j, k, i / WordSize)] |= std::uint64_t(1)
          << (i % WordSize);
      }
    }
  }
}

bool LatticeInside::IsUniform(std::int64_t w, std::int64_t j, std::int64_t k) const
{
  // Of the points of a word, and of all that their tetrahedra reach.
  const std::uint64_t value = this->Word(0, j, k, w);
  if (value != 0 && value != ~std::uint64_t(0))
  {
    return false;
  }
  for (std::int64_t x = std::max<std::int64_t>(w - 1, 0); x <= std::min(w + 1, this->Words - 1);
       ++x)
  {
    for (const auto& row : { std::array<std::int64_t, 3>{ 0, j, k }, { 0, j + 1, k },
           { 0, j, k + 1 }, { 1, j, k }, { 1, j - 1, k }, { 1, j, k - 1 }, { 1, j - 1, k - 1 } })
    {
      if (this->Word(static_cast<int>(row[0]), row[1], row[2], x) != value)
      {
        return false;
      }
    }
  }
  return true;
}
}
