// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/CellPattern.h"

#include <numeric>
#include <tuple>

namespace volumic
{
namespace
{
/** Union-find of a few elements. */
template <std::size_t Size>
class Joins
{
public:
  Joins() { std::iota(this->Parent.begin(), this->Parent.end(), 0); }
  int Find(int n) const
  {
    while (this->Parent[static_cast<std::size_t>(n)] != n)
    {
      n = this->Parent[static_cast<std::size_t>(n)];
    }
    return n;
  }
  void Join(int a, int b) { this->Parent[static_cast<std::size_t>(this->Find(a))] = this->Find(b); }

private:
  std::array<int, Size> Parent;
};

/** A side of a cell: its octants in cyclic order and the edge from each octant to the next one. */
struct SideOfCell
{
  std::array<int, 4> Octant;
  std::array<int, 4> Edge;
  /** Index of this side among the two sides of each edge (CellPattern::SidesOf). */
  static constexpr std::array<int, 4> SideIndex = { 1, 0, 1, 0 };

  SideOfCell(int axis, int high)
  {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    const int first = high << axis;
    this->Octant = { first, first | 1 << b, first | 1 << b | 1 << c, first | 1 << c };
    this->Edge = { CellPattern::EdgeAt(b, 0, high), CellPattern::EdgeAt(c, high, 1),
      CellPattern::EdgeAt(b, 1, high), CellPattern::EdgeAt(c, high, 0) };
  }
};
}

std::array<int, 2> CellPattern::OctantsOf(int edge)
{
  const int axis = edge / 4;
  const int first = (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
  return { first, first | 1 << axis };
}

std::array<int, 2> CellPattern::SidesOf(int edge)
{
  const int axis = edge / 4;
  return { 2 * ((axis + 1) % 3) + (edge & 1), 2 * ((axis + 2) % 3) + (edge >> 1 & 1) };
}

CellPattern::CellPattern(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf)
{
  this->FindArcs(labels, rankOf);
  this->FindCentres(labels, rankOf);
}

void CellPattern::FindArcs(
  const std::array<Number, Octants>& labels, const std::vector<int>& rankOf)
{
  Joins<Edges> sheets;
  Joins<Octants> regions;
  std::array<bool, Edges> isCrossed;
  for (int edge = 0; edge < Edges; ++edge)
  {
    const auto [low, high] = OctantsOf(edge);
    isCrossed[edge] = labels[low] != labels[high];
    if (!isCrossed[edge])
    {
      regions.Join(low, high);
    }
  }
  for (int number = 0; number < Sides; ++number)
  {
    const SideOfCell side(number / 2, number & 1);
    const auto labelAt = [&](int n) { return labels[side.Octant[n % 4]]; };
    const auto isDiagonal = [&](int n)
    {
      return labelAt(n) == labelAt(n + 2) && labelAt(n) != labelAt(n + 1) &&
        labelAt(n) != labelAt(n + 3);
    };
    int joined = -1; // first of the two opposite octants that are connected
    if (isDiagonal(0) && isDiagonal(1))
    {
      joined = rankOf[labelAt(0)] < rankOf[labelAt(1)] ? 0 : 1;
    }
    else if (isDiagonal(0) || isDiagonal(1))
    {
      joined = isDiagonal(0) ? 0 : 1;
    }
    if (joined >= 0)
    {
      this->HasJoins = true;
      regions.Join(side.Octant[joined], side.Octant[joined + 2]);
    }
    std::array<int, 2> first = { -1, -1 }; // an edge of each strand
    for (int n = 0; n < 4; ++n)
    {
      if (isCrossed[side.Edge[n]])
      {
        // A strand joins the two edges at an octant that is not connected.
        const int strand = joined < 0 ? 0 : ((n + (joined == 0 ? 0 : 3)) % 4) / 2;
        this->StrandOf[side.Edge[n]][SideOfCell::SideIndex[n]] = static_cast<signed char>(strand);
        if (first[strand] >= 0)
        {
          sheets.Join(side.Edge[n], first[strand]);
        }
        first[strand] = side.Edge[n];
      }
    }
    this->StrandsOn[number] = static_cast<signed char>((first[0] >= 0) + (first[1] >= 0));
  }
  std::array<signed char, Edges> numberOf;
  numberOf.fill(-1);
  for (int edge = 0; edge < Edges; ++edge)
  {
    this->SheetOf[edge] = -1;
    if (isCrossed[edge])
    {
      signed char& number = numberOf[sheets.Find(edge)];
      number = number < 0 ? static_cast<signed char>(this->Sheets++) : number;
      this->SheetOf[edge] = number;
    }
  }
  for (int octant = 0; octant < Octants; ++octant)
  {
    this->RegionOf[octant] = static_cast<signed char>(regions.Find(octant));
  }
}

void CellPattern::FindCentres(
  const std::array<Number, Octants>& labels, const std::vector<int>& rankOf)
{
  std::array<int, Octants> size = {};
  for (const int region : this->RegionOf)
  {
    ++size[region];
  }
  for (int sheet = 0; sheet < this->Sheets; ++sheet)
  {
    unsigned regionBits = 0; // regions at the sheet
    for (int edge = 0; edge < Edges; ++edge)
    {
      if (this->SheetOf[edge] == sheet)
      {
        const auto [low, high] = OctantsOf(edge);
        regionBits |= 1u << this->RegionOf[low] | 1u << this->RegionOf[high];
      }
    }
    const auto isUnique = [&](int region)
    {
      int count = 0;
      for (int other = 0; other < Octants; ++other)
      {
        count += (regionBits >> other & 1) != 0 && labels[other] == labels[region] ? 1 : 0;
      }
      return count == 1;
    };
    // Prefer the largest region with a unique label, otherwise the region of the lowest rank.
    const auto before = [&](int a, int b)
    {
      const int rankA = rankOf[labels[a]];
      const int rankB = rankOf[labels[b]];
      return std::tuple(
               !isUnique(a), isUnique(a) ? -size[a] : rankA, isUnique(a) ? rankA : -size[a]) <
        std::tuple(!isUnique(b), isUnique(b) ? -size[b] : rankB, isUnique(b) ? rankB : -size[b]);
    };
    int best = -1;
    bool hasRepeated = false;
    for (int region = 0; region < Octants; ++region)
    {
      if ((regionBits >> region & 1) != 0)
      {
        hasRepeated = hasRepeated || !isUnique(region);
        best = best < 0 || before(region, best) ? region : best;
      }
    }
    this->CentreOf[sheet] = static_cast<signed char>(best);
    this->Opened |= hasRepeated ? 1u << sheet : 0u;
  }
}
}
