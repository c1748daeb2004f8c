// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/DualCells.h"

#include "Core/Common/Spans.h"

#include <algorithm>

namespace volumic
{
namespace
{
using LocalPoint = std::array<double, 3>;

/** Fraction of the distance from the middle to the arcs, for cells or sides of several vertices. */
constexpr double ArcFraction = 0.5;
/** Scale of the copied boundary loop of an opened sheet. */
constexpr double CopyScale = 0.5;

LocalPoint ArcPoint(int edge)
{
  LocalPoint point;
  point[edge / 4] = 0.5;
  point[(edge / 4 + 1) % 3] = edge & 1;
  point[(edge / 4 + 2) % 3] = edge >> 1 & 1;
  return point;
}

LocalPoint Between(const LocalPoint& middle, const LocalPoint& end, double fraction)
{
  return { middle[0] + fraction * (end[0] - middle[0]), middle[1] + fraction * (end[1] - middle[1]),
    middle[2] + fraction * (end[2] - middle[2]) };
}

/** Return the mean of the zeros on the edges of a cell, clamped for triangles of similar size. */
LocalPoint MeanOfZeros(const std::array<float, 8>& values)
{
  constexpr double most = 0.24; // distance from the middle of the edge
  LocalPoint sum = { 0., 0., 0. };
  int count = 0;
  for (int edge = 0; edge < CellPattern::Edges; ++edge)
  {
    const auto [low, high] = CellPattern::OctantsOf(edge);
    const double from = values[low];
    const double to = values[high];
    if ((from < 0.) != (to < 0.))
    {
      LocalPoint zero = ArcPoint(edge);
      zero[edge / 4] = std::clamp(from / (from - to), 0.5 - most, 0.5 + most);
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += zero[axis];
      }
      ++count;
    }
  }
  for (double& at : sum)
  {
    at /= count;
  }
  return sum;
}

template <typename T>
std::array<T, 8> OctantsAt(
  const std::vector<T>& low, const std::vector<T>& high, std::size_t at, std::size_t row)
{
  return { low[at], low[at + 1], low[at + row], low[at + row + 1], high[at], high[at + 1],
    high[at + row], high[at + row + 1] };
}

/** Return a position between `middle` and the mean of the arcs for which use(edge) is true. */
template <typename Use>
LocalPoint TowardsArcs(const LocalPoint& middle, const Use& use)
{
  LocalPoint sum = { 0., 0., 0. };
  double count = 0.;
  for (int edge = 0; edge < CellPattern::Edges; ++edge)
  {
    if (use(edge))
    {
      const LocalPoint arc = ArcPoint(edge);
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += arc[axis];
      }
      count += 1.;
    }
  }
  return Between(middle, { sum[0] / count, sum[1] / count, sum[2] / count }, ArcFraction);
}

LocalPoint ApexPoint(const CellPattern& pattern, int sheet)
{
  const LocalPoint middle = { 0.5, 0.5, 0.5 };
  return pattern.Sheets == 1
    ? middle
    : TowardsArcs(middle, [&](int edge) { return pattern.SheetOf[edge] == sheet; });
}

LocalPoint StrandPoint(const CellPattern& pattern, int side, int strand)
{
  LocalPoint middle = { 0.5, 0.5, 0.5 };
  middle[side / 2] = side & 1;
  if (pattern.StrandsOn[side] == 1)
  {
    return middle;
  }
  return TowardsArcs(middle,
    [&](int edge)
    {
      const auto sides = CellPattern::SidesOf(edge);
      const int n = sides[0] == side ? 0 : sides[1] == side ? 1 : -1;
      return n >= 0 && pattern.SheetOf[edge] >= 0 && pattern.StrandOf[edge][n] == strand;
    });
}
}

DualCells::DualCells(const DualGrid& grid) : Grid(grid), Rows(grid.Size[1] - 1) {}

bool DualCells::IsPlainPattern(unsigned bits)
{
  static const std::array<bool, 256> isPlain = []
  {
    std::array<bool, 256> table;
    for (unsigned pattern = 0; pattern < 256; ++pattern)
    {
      std::array<Number, 8> labels;
      for (unsigned octant = 0; octant < 8; ++octant)
      {
        labels[octant] = static_cast<Number>(1 - (pattern >> octant & 1));
      }
      table[pattern] = CellPattern(labels, { 0, 1 }).IsPlain();
    }
    return table;
  }();
  return isPlain[bits];
}

void DualCells::Make(Executor& executor)
{
  const int layers = this->Grid.Size[2] - 1;
  for (int first = 0; first < layers; first += SlabSize)
  {
    this->Slabs.emplace_back();
    this->Slabs.back().First = first;
    this->Slabs.back().End = std::min(first + SlabSize, layers);
  }
  ForSpans(executor, this->Slabs.size(), 1,
    [&](std::size_t slab, std::size_t, std::size_t) { this->FindCells(this->Slabs[slab]); });
  ForSpans(executor, this->Slabs.size(), 1,
    [&](std::size_t slab, std::size_t, std::size_t)
    { this->AddPointsOfSpecials(this->Slabs[slab]); });
}

void DualCells::FindCells(DualSlab& slab) const
{
  std::vector<Number> low(this->SliceSize());
  std::vector<Number> high(this->SliceSize());
  std::vector<float> lowValues(this->Grid.CopyValues ? this->SliceSize() : 0);
  std::vector<float> highValues(lowValues.size());
  const auto copy = [&](int k)
  {
    low.swap(high);
    this->Grid.CopySlice(k, high.data());
    if (this->Grid.CopyValues)
    {
      lowValues.swap(highValues);
      this->Grid.CopyValues(k, highValues.data());
    }
  };
  copy(slab.First);
  const auto row = static_cast<std::size_t>(this->Grid.Size[0]);
  for (int k = slab.First; k < slab.End; ++k)
  {
    copy(k + 1);
    for (int j = 0; j < this->Rows; ++j)
    {
      slab.Row.push_back(slab.X.size());
      for (int i = 0; i + 1 < this->Grid.Size[0]; ++i)
      {
        const std::size_t at = static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i);
        const std::array<Number, 8> labels = OctantsAt(low, high, at, row);
        if (std::any_of(
              labels.begin(), labels.end(), [&labels](Number label) { return label != labels[0]; }))
        {
          this->AddCell(slab, { i, j, k }, labels,
            this->Grid.CopyValues ? MeanOfZeros(OctantsAt(lowValues, highValues, at, row))
                                  : LocalPoint{ 0.5, 0.5, 0.5 });
        }
      }
    }
  }
  slab.Row.push_back(slab.X.size());
}

void DualCells::AddCell(DualSlab& slab, const std::array<int, 3>& at,
  const std::array<Number, 8>& labels, const LocalPoint& vertex) const
{
  slab.X.push_back(at[0]);
  CellPattern pattern;
  if (this->IsPlainPair(labels) || (pattern = CellPattern(labels, this->Grid.RankOf)).IsPlain())
  {
    slab.Contents.push_back(static_cast<int>(slab.Points.size()));
    slab.Points.push_back(this->PositionOf(at, vertex));
    return;
  }
  slab.Contents.push_back(-1 - static_cast<int>(slab.Special.size()));
  SpecialCell special = {};
  special.Pattern = pattern;
  special.Labels = labels;
  special.At = at;
  slab.Special.push_back(special);
}

bool DualCells::IsPlainPair(const std::array<Number, 8>& labels) const
{
  unsigned others = 0; // bits of the octants whose label is not that of the first octant
  Number other = labels[0];
  for (unsigned octant = 1; octant < 8; ++octant)
  {
    if (labels[octant] != labels[0])
    {
      if (others != 0 && labels[octant] != other)
      {
        return false;
      }
      other = labels[octant];
      others |= 1u << octant;
    }
  }
  const bool isEarlier = this->Grid.RankOf[other] < this->Grid.RankOf[labels[0]];
  return IsPlainPattern(isEarlier ? others : 255u ^ others);
}

float DualCells::CoordinateOf(const std::array<int, 3>& cell, int axis, double at) const
{
  const int n = cell[axis];
  const float plane = this->Grid.Planes[axis][n];
  const bool isFirst = n == 0;
  if (this->IsAtSide(cell, axis) && (isFirst ? at < 1. : at > 0.))
  {
    return plane; // All points except for those of the inner side lie in the plane of the box.
  }
  const double end = this->Grid.Centres[axis][at < 0.5 ? n : n + 1];
  return static_cast<float>(plane + (end - plane) * (at < 0.5 ? 1. - 2. * at : 2. * at - 1.));
}

Vector DualCells::PositionOf(const std::array<int, 3>& cell, const LocalPoint& at) const
{
  return { this->CoordinateOf(cell, 0, at[0]), this->CoordinateOf(cell, 1, at[1]),
    this->CoordinateOf(cell, 2, at[2]) };
}

void DualCells::AddPointsOfSpecials(DualSlab& slab) const
{
  for (SpecialCell& special : slab.Special)
  {
    const auto add = [&](const LocalPoint& at)
    {
      slab.Points.push_back(this->PositionOf(special.At, at));
      return static_cast<int>(slab.Points.size()) - 1;
    };
    const CellPattern& pattern = special.Pattern;
    for (int sheet = 0; sheet < pattern.Sheets; ++sheet)
    {
      special.Apex[sheet] = pattern.IsOpened(sheet) ? -1 : add(ApexPoint(pattern, sheet));
    }
    for (int side = 0; side < CellPattern::Sides; ++side)
    {
      std::array<int, 3> below = special.At;
      --below[side / 2];
      const bool isOwn = (side & 1) == 1 || !this->IsSpecial(below);
      for (int strand = 0; strand < 2; ++strand)
      {
        special.InnerStrand[side][strand] = -1;
        special.Strand[side][strand] =
          isOwn && strand < pattern.StrandsOn[side] ? add(StrandPoint(pattern, side, strand)) : -1;
      }
    }
    const LocalPoint middle = { 0.5, 0.5, 0.5 };
    for (int edge = 0; edge < CellPattern::Edges; ++edge)
    {
      special.InnerArc[edge] = -1;
      const int sheet = pattern.SheetOf[edge];
      if (sheet < 0 || !pattern.IsOpened(sheet))
      {
        continue;
      }
      LocalPoint arc = ArcPoint(edge);
      const auto sides = CellPattern::SidesOf(edge);
      for (int n = 0; n < 2; ++n)
      {
        const int strand = pattern.StrandOf[edge][n];
        const LocalPoint point = StrandPoint(pattern, sides[n], strand);
        int& inner = special.InnerStrand[sides[n]][strand];
        inner = inner >= 0 ? inner : add(Between(middle, point, CopyScale));
        // In the plane of a box side, this copy would coincide with copies of other arcs.
        arc = this->IsOppositeToSide(special.At, sides[n]) ? Between(arc, point, 0.5) : arc;
      }
      special.InnerArc[edge] = add(Between(middle, arc, CopyScale));
    }
  }
}

bool DualCells::IsSpecial(const std::array<int, 3>& cell) const
{
  if (cell[0] < 0 || cell[1] < 0 || cell[2] < 0)
  {
    return false;
  }
  const DualSlab& slab = this->Slabs[static_cast<std::size_t>(cell[2] / SlabSize)];
  const std::size_t row = static_cast<std::size_t>(cell[2] - slab.First) * this->Rows + cell[1];
  const auto first = slab.X.begin() + static_cast<std::ptrdiff_t>(slab.Row[row]);
  const auto end = slab.X.begin() + static_cast<std::ptrdiff_t>(slab.Row[row + 1]);
  const auto at = std::lower_bound(first, end, cell[0]);
  return at != end && *at == cell[0] &&
    slab.Contents[static_cast<std::size_t>(at - slab.X.begin())] < 0;
}
}
