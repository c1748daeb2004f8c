// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LatticeInside.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volumic
{
namespace
{
/**
 * What the lattice is set off by, in pitches, so that rows hit no corner of a surface on round
 * numbers: sqrt 2 - 1, (3 - sqrt 5) / 2 and sqrt 5 - 2.
 */
constexpr double Offset[3] = { 0.4142135623, 0.3819660113, 0.2360679775 };
/** Rows so near to a triangle are looked at too, in pitches: for rounding. */
constexpr double Rounding = 1e-6;
}

LatticeInside::LatticeInside(const IndexedSurface& surface, double pitch)
  : Surface(surface), Pitch(pitch)
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
  this->FindCrossings(0);
  this->FindCrossings(1);
}

void LatticeInside::FindCrossings(int kind)
{
  std::vector<Crossing>& crossings = this->Crossings[kind];
  const auto first = [&](int axis, double from)
  {
    const double place = (from - this->Coordinate(kind, axis, 0)) / this->Pitch;
    return std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(place - Rounding)), 0);
  };
  for (const Triangle& t : this->Surface.Triangles)
  {
    const Point* p[3];
    for (int c = 0; c < 3; ++c)
    {
      p[c] = &this->Surface.Points[t[c]];
    }
    const double top = std::max({ (*p[0])[2], (*p[1])[2], (*p[2])[2] });
    const double bottom = std::min({ (*p[0])[2], (*p[1])[2], (*p[2])[2] });
    for (std::int64_t k = first(2, bottom); k < this->Count[2]; ++k)
    {
      const double z = this->Coordinate(kind, 2, k);
      if (z > top + Rounding * this->Pitch)
      {
        break;
      }
      // Where the plane at z cuts the triangle.
      double low = std::numeric_limits<double>::max();
      double high = -low;
      for (int c = 0; c < 3; ++c)
      {
        const Point& a = *p[c];
        const Point& b = *p[(c + 1) % 3];
        const double share = a[2] != b[2] ? std::clamp((z - a[2]) / (b[2] - a[2]), 0., 1.) : 0.;
        if ((a[2] - z) * (b[2] - z) <= 0. || share == 0. || share == 1.)
        {
          low = std::min(low, a[1] + share * (b[1] - a[1]));
          high = std::max(high, a[1] + share * (b[1] - a[1]));
        }
      }
      for (std::int64_t j = first(1, low); j < this->Count[1]; ++j)
      {
        const double y = this->Coordinate(kind, 1, j);
        if (y > high + Rounding * this->Pitch)
        {
          break;
        }
        const RowCrossing where = RowCrossing::Of(*p[0], *p[1], *p[2], y, z);
        if (where.Winding != 0)
        {
          crossings.push_back({ k * this->Count[1] + j, where });
        }
      }
    }
  }
  std::sort(crossings.begin(), crossings.end(),
    [](const Crossing& a, const Crossing& b)
    { return a.Row != b.Row ? a.Row < b.Row : a.Where.X < b.Where.X; });
}

void LatticeInside::Fill(std::int64_t k)
{
  for (int kind : { 0, 1 })
  {
    const auto begin = static_cast<std::ptrdiff_t>(this->PlaceOfWord(kind, 0, k, 0));
    std::fill_n(this->Bits.begin() + begin, this->Count[1] * this->Words, std::uint64_t(0));
    const std::vector<Crossing>& crossings = this->Crossings[kind];
    const double start = this->Coordinate(kind, 0, 0);
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
