// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/DualMesh.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/CellPattern.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;
using Place = std::array<double, 3>; ///< in a cell, from 0 to 1

/** Layers of cells that a thread makes at a time. */
constexpr int SlabSize = 16;
/** How far vertices of a cell or side with several go from its middle to their arcs. */
constexpr double Apart = 0.5;
/** The size of the copy of an opened sheet's rim. */
constexpr double Copied = 0.5;

/** A cell that is not plain. Points: of its slab; -1: it has none. */
struct SpecialCell
{
  CellPattern Pattern;
  std::array<Number, 8> Labels;
  std::array<int, 3> At;
  std::array<int, 4> Apex; ///< of each sheet
  std::array<std::array<int, 2>, 6> Strand;      ///< where they are those of this cell
  std::array<std::array<int, 2>, 6> InnerStrand; ///< of opened sheets, the copies
  std::array<int, 12> InnerArc;
};

/** Some layers of cells, and the voxel faces and special cells in them. */
struct Slab
{
  int First = 0;
  int End = 0;
  // Rows of cells, y fastest: of each the first of its crossed cells, their X and what they have.
  std::vector<std::size_t> Row;
  std::vector<int> X;
  std::vector<int> Has; ///< a point, or -1 less the number of a special cell
  std::vector<SpecialCell> Special;
  std::vector<Vector> Points;
  /** Points of this slab, or, negative, -1 less one of the slab before. */
  std::vector<InterfaceMesh::Face> Faces;
};

/** The four cells about a voxel face across an axis, round about: whether they are lower along the
 * two next axes. */
constexpr std::array<std::array<int, 2>, 4> CellsAbout = { { { 0, 0 }, { 1, 0 }, { 1, 1 },
  { 0, 1 } } };
/** The sides of these cells that lead to the one before and to the next one: that across the first
 * of the two axes, or the second. */
constexpr std::array<int, 4> SideBefore = { 1, 0, 1, 0 };
constexpr std::array<int, 4> SideAfter = { 0, 1, 0, 1 };

class DualMesher
{
public:
  explicit DualMesher(const DualGrid& grid) : Grid(grid), Rows(grid.Size[1] - 1)
  {
    // Of two labels, which of 256 patterns are plain: bits of octants of the earlier rank.
    for (unsigned bits = 0; bits < 256; ++bits)
    {
      std::array<Number, 8> labels;
      for (unsigned octant = 0; octant < 8; ++octant)
      {
        labels[octant] = static_cast<Number>(1 - (bits >> octant & 1));
      }
      this->IsPlain[bits] = CellPattern(labels, { 0, 1 }).IsPlain();
    }
  }

  InterfaceMesh Make(Executor& executor)
  {
    const int layers = this->Grid.Size[2] - 1;
    for (int first = 0; first < layers; first += SlabSize)
    {
      this->Slabs.emplace_back();
      this->Slabs.back().First = first;
      this->Slabs.back().End = std::min(first + SlabSize, layers);
    }
    const auto forSlabs = [&](void (DualMesher::*make)(std::size_t))
    {
      ForSpans(executor, this->Slabs.size(), 1,
        [&](std::size_t slab, std::size_t, std::size_t) { (this->*make)(slab); });
    };
    forSlabs(&DualMesher::FindCells);
    forSlabs(&DualMesher::AddPointsOfSpecials);
    forSlabs(&DualMesher::AddFaces);
    return this->Joined(executor);
  }

private:
  std::size_t SliceSize() const
  {
    return static_cast<std::size_t>(this->Grid.Size[0]) * this->Grid.Size[1];
  }

  // ---- Cells ----

  void FindCells(std::size_t number)
  {
    Slab& slab = this->Slabs[number];
    std::vector<Number> low(this->SliceSize());
    std::vector<Number> high(this->SliceSize());
    this->Grid.CopySlice(slab.First, high.data());
    for (int k = slab.First; k < slab.End; ++k)
    {
      low.swap(high);
      this->Grid.CopySlice(k + 1, high.data());
      for (int j = 0; j < this->Rows; ++j)
      {
        slab.Row.push_back(slab.X.size());
        const std::size_t row = static_cast<std::size_t>(j) * this->Grid.Size[0];
        const std::size_t next = row + static_cast<std::size_t>(this->Grid.Size[0]);
        const std::array<const Number*, 4> rows = { &low[row], &low[next], &high[row],
          &high[next] };
        this->FindCellsOfRow(slab, rows, j, k);
      }
    }
    slab.Row.push_back(slab.X.size());
  }

  void FindCellsOfRow(Slab& slab, const std::array<const Number*, 4>& rows, int j, int k)
  {
    for (int i = 0; i + 1 < this->Grid.Size[0]; ++i)
    {
      std::array<Number, 8> labels;
      unsigned others = 0; // than the first one, bits of octants
      for (unsigned n = 0; n < 4; ++n)
      {
        labels[2 * n] = rows[n][i];
        labels[2 * n + 1] = rows[n][i + 1];
        others |= (labels[2 * n] != labels[0] ? 1u : 0u) << 2 * n |
          (labels[2 * n + 1] != labels[0] ? 2u : 0u) << 2 * n;
      }
      if (others == 0)
      {
        continue;
      }
      slab.X.push_back(i);
      if (this->IsPlainCell(labels, others))
      {
        slab.Has.push_back(static_cast<int>(slab.Points.size()));
        slab.Points.push_back(this->PlaceOf({ i, j, k }, { 0.5, 0.5, 0.5 }));
        continue;
      }
      SpecialCell special = {};
      special.Pattern = CellPattern(labels, this->Grid.RankOf);
      if (special.Pattern.IsPlain())
      {
        slab.Has.push_back(static_cast<int>(slab.Points.size()));
        slab.Points.push_back(this->PlaceOf({ i, j, k }, { 0.5, 0.5, 0.5 }));
        continue;
      }
      special.Labels = labels;
      special.At = { i, j, k };
      slab.Has.push_back(-1 - static_cast<int>(slab.Special.size()));
      slab.Special.push_back(special);
    }
  }

  /** Whether it has two labels, and a pattern that is plain. */
  bool IsPlainCell(const std::array<Number, 8>& labels, unsigned others) const
  {
    unsigned first = 0;
    while ((others >> first & 1) == 0)
    {
      ++first;
    }
    unsigned same = 0;
    for (unsigned octant = first; octant < 8; ++octant)
    {
      same |= (labels[octant] == labels[first] ? 1u : 0u) << octant;
    }
    const bool isEarlier =
      this->Grid.RankOf[labels[first]] < this->Grid.RankOf[labels[0]];
    return same == others && this->IsPlain[isEarlier ? same : 255u ^ same];
  }

  // ---- Points ----

  bool IsOutside(Number label) const
  {
    return this->Grid.Outside >= 0 && label == this->Grid.Outside;
  }

  /** Along an axis the only plane in which a cell may have points, at the side of a box. */
  bool IsAtSide(const std::array<int, 3>& cell, int axis) const
  {
    return this->Grid.Outside >= 0 &&
      (cell[axis] == 0 || cell[axis] == this->Grid.Size[axis] - 2);
  }

  float CoordinateOf(const std::array<int, 3>& cell, int axis, double at) const
  {
    const int n = cell[axis];
    const float plane = this->Grid.Planes[axis][n];
    const bool isFirst = n == 0;
    if (this->IsAtSide(cell, axis) && (isFirst ? at < 1. : at > 0.))
    {
      return plane; // Labels meet what is outside there; but those of the side opposite to it do not.
    }
    const double end = this->Grid.Centres[axis][at < 0.5 ? n : n + 1];
    return static_cast<float>(plane + (end - plane) * (at < 0.5 ? 1. - 2. * at : 2. * at - 1.));
  }

  Vector PlaceOf(const std::array<int, 3>& cell, const Place& at) const
  {
    return { this->CoordinateOf(cell, 0, at[0]), this->CoordinateOf(cell, 1, at[1]),
      this->CoordinateOf(cell, 2, at[2]) };
  }

  static Place PlaceOfArc(int edge)
  {
    Place place;
    place[edge / 4] = 0.5;
    place[(edge / 4 + 1) % 3] = edge & 1;
    place[(edge / 4 + 2) % 3] = edge >> 1 & 1;
    return place;
  }

  static Place Between(const Place& middle, const Place& end, double share)
  {
    return { middle[0] + share * (end[0] - middle[0]), middle[1] + share * (end[1] - middle[1]),
      middle[2] + share * (end[2] - middle[2]) };
  }

  /** From a middle so far to the arcs of which use(edge) is true. */
  template <typename Use>
  static Place TowardsArcs(const Place& middle, const Use& use)
  {
    Place sum = { 0., 0., 0. };
    double count = 0.;
    for (int edge = 0; edge < CellPattern::Edges; ++edge)
    {
      if (use(edge))
      {
        const Place arc = PlaceOfArc(edge);
        for (int axis = 0; axis < 3; ++axis)
        {
          sum[axis] += arc[axis];
        }
        count += 1.;
      }
    }
    return Between(middle, { sum[0] / count, sum[1] / count, sum[2] / count }, Apart);
  }

  static Place PlaceOfApex(const CellPattern& pattern, int sheet)
  {
    const Place middle = { 0.5, 0.5, 0.5 };
    return pattern.Sheets == 1
      ? middle
      : TowardsArcs(middle, [&](int edge) { return pattern.SheetOf[edge] == sheet; });
  }

  static Place PlaceOfStrand(const CellPattern& pattern, int side, int strand)
  {
    Place middle = { 0.5, 0.5, 0.5 };
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

  /** Whether a cell is at the side of a box, with this one of its own sides within the box. */
  bool IsOppositeToSide(const std::array<int, 3>& cell, int side) const
  {
    return this->IsAtSide(cell, side / 2) && ((side & 1) == 1) == (cell[side / 2] == 0);
  }

  void AddPointsOfSpecials(std::size_t number)
  {
    Slab& slab = this->Slabs[number];
    for (SpecialCell& special : slab.Special)
    {
      const auto add = [&](const Place& at)
      {
        slab.Points.push_back(this->PlaceOf(special.At, at));
        return static_cast<int>(slab.Points.size()) - 1;
      };
      const CellPattern& pattern = special.Pattern;
      for (int sheet = 0; sheet < pattern.Sheets; ++sheet)
      {
        special.Apex[sheet] =
          pattern.IsOpened(sheet) ? -1 : add(PlaceOfApex(pattern, sheet));
      }
      for (int side = 0; side < CellPattern::Sides; ++side)
      {
        std::array<int, 3> below = special.At;
        --below[side / 2];
        const bool isOwn = (side & 1) == 1 || !this->SpecialAt(below).Cell;
        for (int strand = 0; strand < 2; ++strand)
        {
          special.InnerStrand[side][strand] = -1;
          special.Strand[side][strand] = isOwn && strand < pattern.StrandsOn[side]
            ? add(PlaceOfStrand(pattern, side, strand))
            : -1;
        }
      }
      const Place middle = { 0.5, 0.5, 0.5 };
      for (int edge = 0; edge < CellPattern::Edges; ++edge)
      {
        special.InnerArc[edge] = -1;
        const int sheet = pattern.SheetOf[edge];
        if (sheet < 0 || !pattern.IsOpened(sheet))
        {
          continue;
        }
        Place arc = PlaceOfArc(edge);
        const auto sides = CellPattern::SidesOf(edge);
        for (int n = 0; n < 2; ++n)
        {
          const int strand = pattern.StrandOf[edge][n];
          const Place place = PlaceOfStrand(pattern, sides[n], strand);
          int& inner = special.InnerStrand[sides[n]][strand];
          inner = inner >= 0 ? inner : add(Between(middle, place, Copied));
          // In the plane of a box's side the copies of this and of others would coincide.
          arc = this->IsOppositeToSide(special.At, sides[n]) ? Between(arc, place, 0.5) : arc;
        }
        special.InnerArc[edge] = add(Between(middle, arc, Copied));
      }
    }
  }

  /** A cell, and its slab. */
  struct Found
  {
    const SpecialCell* Cell = nullptr;
    std::size_t Slab = 0;
  };

  Found SpecialAt(const std::array<int, 3>& cell) const
  {
    Found found;
    if (cell[0] < 0 || cell[1] < 0 || cell[2] < 0)
    {
      return found;
    }
    found.Slab = static_cast<std::size_t>(cell[2] / SlabSize);
    const Slab& slab = this->Slabs[found.Slab];
    const std::size_t row =
      static_cast<std::size_t>(cell[2] - slab.First) * this->Rows + cell[1];
    const auto first = slab.X.begin() + static_cast<std::ptrdiff_t>(slab.Row[row]);
    const auto end = slab.X.begin() + static_cast<std::ptrdiff_t>(slab.Row[row + 1]);
    const auto at = std::lower_bound(first, end, cell[0]);
    if (at != end && *at == cell[0])
    {
      const int has = slab.Has[static_cast<std::size_t>(at - slab.X.begin())];
      found.Cell = has < 0 ? &slab.Special[static_cast<std::size_t>(-1 - has)] : nullptr;
    }
    return found;
  }

  // ---- Faces ----

  /** What the cells of two layers have, those of the voxel faces of a slice. */
  struct Layers
  {
    std::vector<int> Below; ///< as Slab::Has; NoCell
    std::vector<int> Above;
    bool IsBelowBefore = false; ///< in the slab before
  };
  static constexpr int NoCell = -2147483647;

  void Fill(std::vector<int>& layer, int k) const
  {
    layer.assign(this->SliceSize(), NoCell);
    if (k < 0)
    {
      return;
    }
    const Slab& slab = this->Slabs[static_cast<std::size_t>(k / SlabSize)];
    for (int j = 0; j < this->Rows; ++j)
    {
      const std::size_t row = static_cast<std::size_t>(k - slab.First) * this->Rows + j;
      for (std::size_t n = slab.Row[row]; n < slab.Row[row + 1]; ++n)
      {
        layer[static_cast<std::size_t>(j) * this->Grid.Size[0] + slab.X[n]] = slab.Has[n];
      }
    }
  }

  void AddFaces(std::size_t number)
  {
    Slab& slab = this->Slabs[number];
    std::vector<Number> slice(this->SliceSize());
    std::vector<Number> next(this->SliceSize());
    Layers layers;
    this->Grid.CopySlice(slab.First, next.data());
    this->Fill(layers.Above, slab.First - 1);
    for (int k = slab.First; k < slab.End; ++k)
    {
      slice.swap(next);
      layers.Below.swap(layers.Above);
      layers.IsBelowBefore = k == slab.First;
      this->Grid.CopySlice(k + 1, next.data());
      this->Fill(layers.Above, k);
      for (int j = 0; j + 1 < this->Grid.Size[1]; ++j)
      {
        const std::size_t row = static_cast<std::size_t>(j) * this->Grid.Size[0];
        for (int i = 0; i + 1 < this->Grid.Size[0]; ++i)
        {
          const std::size_t at = row + static_cast<std::size_t>(i);
          const std::array<Number, 3> beyond = { slice[at + 1],
            slice[at + static_cast<std::size_t>(this->Grid.Size[0])], next[at] };
          for (int axis = 0; axis < 3; ++axis)
          {
            if (slice[at] != beyond[axis])
            {
              this->AddVoxelFace(number, layers, { i, j, k }, axis, slice[at], beyond[axis]);
            }
          }
        }
      }
    }
    for (const SpecialCell& special : slab.Special)
    {
      for (int sheet = 0; sheet < special.Pattern.Sheets; ++sheet)
      {
        if (special.Pattern.IsOpened(sheet))
        {
          this->AddCaps(slab, special, sheet);
        }
      }
    }
  }

  /** A triangle with labels behind and in front of it; at a side of a box with its number. */
  void AddTriangle(
    Slab& slab, const std::array<int, 3>& vertices, Number behind, Number front, int side) const
  {
    InterfaceMesh::Face face = { vertices, behind, front };
    if (this->IsOutside(behind) || this->IsOutside(front))
    {
      const Number inside = this->IsOutside(behind) ? front : behind;
      if (inside == 0)
      {
        return;
      }
      const auto number = static_cast<Number>(this->Grid.Outside + side);
      face.Behind = this->IsOutside(behind) ? number : behind;
      face.Front = this->IsOutside(front) ? number : front;
    }
    if (face.Behind > face.Front)
    {
      std::swap(face.Behind, face.Front);
      std::swap(face.Vertex[1], face.Vertex[2]);
    }
    slab.Faces.push_back(face);
  }

  void AddVoxelFace(std::size_t number, const Layers& layers, const std::array<int, 3>& voxel,
    int axis, Number behind, Number front)
  {
    Slab& slab = this->Slabs[number];
    const std::array<int, 2> across = { (axis + 1) % 3, (axis + 2) % 3 };
    std::array<std::array<int, 3>, 4> cells;
    std::array<int, 4> has;
    std::array<bool, 4> isBefore;
    bool arePlain = true;
    for (int q = 0; q < 4; ++q)
    {
      cells[q] = voxel;
      cells[q][across[0]] -= CellsAbout[q][0];
      cells[q][across[1]] -= CellsAbout[q][1];
      const bool isBelow = cells[q][2] < voxel[2];
      has[q] = (isBelow ? layers.Below
                        : layers.Above)[static_cast<std::size_t>(cells[q][1]) * this->Grid.Size[0] +
        cells[q][0]];
      isBefore[q] = isBelow && layers.IsBelowBefore;
      arePlain = arePlain && has[q] >= 0;
    }
    const auto refer = [](int point, bool before) { return before ? -1 - point : point; };
    const int side = 2 * axis + (voxel[axis] == 0 ? 0 : 1);
    if (arePlain)
    {
      // All diagonals are of cells of one parity, or safe distances would be shorter; alike in
      // opposite sides of a box.
      const bool isInSide = this->IsOutside(behind) || this->IsOutside(front);
      const int turn =
        (voxel[across[0]] + voxel[across[1]] + (isInSide ? 0 : voxel[axis])) & 1;
      for (int half = 0; half < 2; ++half)
      {
        std::array<int, 3> vertices;
        for (int n = 0; n < 3; ++n)
        {
          const int q = (turn + 2 * half + n) % 4;
          vertices[n] = refer(has[q], isBefore[q]);
        }
        this->AddTriangle(slab, vertices, behind, front, side);
      }
      return;
    }
    std::array<Found, 4> special;
    for (int q = 0; q < 4; ++q)
    {
      special[q].Slab = number - (isBefore[q] ? 1 : 0);
      special[q].Cell = has[q] < 0
        ? &this->Slabs[special[q].Slab].Special[static_cast<std::size_t>(-1 - has[q])]
        : nullptr;
    }
    std::array<int, 20> ring;
    int count = 0;
    for (int q = 0; q < 4; ++q)
    {
      const int edge = CellPattern::EdgeAt(axis, CellsAbout[q][0], CellsAbout[q][1]);
      const Found& here = special[q];
      const int before = (q + 3) % 4;
      if (here.Cell || special[before].Cell)
      {
        // That cell of the two which is special, and if both are, the lower one, has the strand.
        const int place = SideBefore[q];
        const bool isHigh = CellsAbout[q][place] == 1; // of this cell
        const bool isOfHere = here.Cell && (isHigh || !special[before].Cell);
        const int q0 = isOfHere ? q : before;
        const int edge0 = isOfHere
          ? edge
          : CellPattern::EdgeAt(axis, CellsAbout[before][0], CellsAbout[before][1]);
        const int strand = special[q0].Cell->Pattern.StrandOf[edge0][place];
        const int sideOfCell = CellPattern::SidesOf(edge0)[place];
        ring[count++] =
          refer(special[q0].Cell->Strand[sideOfCell][strand], isBefore[q0]);
      }
      if (!here.Cell)
      {
        ring[count++] = refer(has[q], isBefore[q]);
        continue;
      }
      const CellPattern& pattern = here.Cell->Pattern;
      const int sheet = pattern.SheetOf[edge];
      if (!pattern.IsOpened(sheet))
      {
        ring[count++] = refer(here.Cell->Apex[sheet], isBefore[q]);
        continue;
      }
      const auto inner = [&](int place)
      {
        return here.Cell->InnerStrand[CellPattern::SidesOf(edge)[place]]
                                     [pattern.StrandOf[edge][place]];
      };
      ring[count++] = refer(inner(SideBefore[q]), isBefore[q]);
      ring[count++] = refer(here.Cell->InnerArc[edge], isBefore[q]);
      ring[count++] = refer(inner(SideAfter[q]), isBefore[q]);
    }
    const int centre = static_cast<int>(slab.Points.size());
    std::array<float, 3> place;
    for (int n = 0; n < 3; ++n)
    {
      place[n] = n == axis ? this->Grid.Planes[n][voxel[n]] : this->Grid.Centres[n][voxel[n]];
    }
    slab.Points.push_back({ place[0], place[1], place[2] });
    for (int n = 0; n < count; ++n)
    {
      this->AddTriangle(slab, { centre, ring[n], ring[(n + 1) % count] }, behind, front, side);
    }
  }

  /** Of an opened sheet, the fans of all regions but that which has the centre. */
  void AddCaps(Slab& slab, const SpecialCell& special, int sheet)
  {
    const CellPattern& pattern = special.Pattern;
    const int centre = pattern.CentreOf[sheet];
    for (int region = 0; region < CellPattern::Octants; ++region)
    {
      if (pattern.RegionOf[region] != region ||
        special.Labels[region] == special.Labels[centre])
      {
        continue;
      }
      std::vector<std::array<int, 2>> rim; // counter-clockwise, seen from the centre
      for (int edge = 0; edge < CellPattern::Edges; ++edge)
      {
        const auto [low, high] = CellPattern::OctantsOf(edge);
        const bool isLow = pattern.RegionOf[low] == region;
        if (pattern.SheetOf[edge] != sheet || isLow == (pattern.RegionOf[high] == region))
        {
          continue;
        }
        int q = 0; // the cell's place about the arc's voxel face
        while (CellsAbout[q][0] != (edge & 1) || CellsAbout[q][1] != (edge >> 1 & 1))
        {
          ++q;
        }
        const auto inner = [&](int place)
        {
          return special
            .InnerStrand[CellPattern::SidesOf(edge)[place]][pattern.StrandOf[edge][place]];
        };
        const int arc = special.InnerArc[edge];
        const int first = isLow ? inner(SideAfter[q]) : inner(SideBefore[q]);
        const int last = isLow ? inner(SideBefore[q]) : inner(SideAfter[q]);
        rim.push_back({ first, arc });
        rim.push_back({ arc, last });
      }
      if (!rim.empty())
      {
        this->AddCap(slab, special, rim, special.Labels[region], special.Labels[centre]);
      }
    }
  }

  void AddCap(Slab& slab, const SpecialCell& special, const std::vector<std::array<int, 2>>& rim,
    Number inside, Number outside)
  {
    VectorD sum;
    for (const std::array<int, 2>& piece : rim)
    {
      sum += VectorD(slab.Points[static_cast<std::size_t>(piece[0])]);
    }
    Vector middle(sum * (1. / static_cast<double>(rim.size())));
    int side = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (this->IsAtSide(special.At, axis))
      {
        side = 2 * axis + (special.At[axis] == 0 ? 0 : 1);
        const float plane = this->Grid.Planes[axis][special.At[axis]];
        (axis == 0 ? middle.X : axis == 1 ? middle.Y : middle.Z) = plane;
      }
    }
    const int centre = static_cast<int>(slab.Points.size());
    slab.Points.push_back(middle);
    for (const std::array<int, 2>& piece : rim)
    {
      this->AddTriangle(slab, { centre, piece[0], piece[1] }, inside, outside, side);
    }
  }

  // ---- The mesh ----

  InterfaceMesh Joined(Executor& executor)
  {
    std::vector<std::size_t> first(this->Slabs.size() + 1, 0);
    std::vector<std::size_t> firstFace = first;
    for (std::size_t s = 0; s < this->Slabs.size(); ++s)
    {
      first[s + 1] = first[s] + this->Slabs[s].Points.size();
      firstFace[s + 1] = firstFace[s] + this->Slabs[s].Faces.size();
    }
    LargeVector<Vector> points(first.back());
    LargeVector<InterfaceMesh::Face> faces(firstFace.back());
    ForSpans(executor, this->Slabs.size(), 1,
      [&](std::size_t s, std::size_t, std::size_t)
      {
        Slab& slab = this->Slabs[s];
        std::copy(slab.Points.begin(), slab.Points.end(),
          points.begin() + static_cast<std::ptrdiff_t>(first[s]));
        for (std::size_t f = 0; f < slab.Faces.size(); ++f)
        {
          InterfaceMesh::Face face = slab.Faces[f];
          for (int& v : face.Vertex)
          {
            v = v < 0 ? static_cast<int>(first[s - 1]) - 1 - v : static_cast<int>(first[s]) + v;
          }
          faces[firstFace[s] + f] = face;
        }
        slab = Slab();
      });
    InterfaceMesh mesh;
    if (this->Grid.Outside >= 0)
    {
      mesh.FirstSide = this->Grid.Outside;
      for (int axis = 0; axis < 3; ++axis)
      {
        mesh.Planes[2 * axis] = this->Grid.Planes[axis].front();
        mesh.Planes[2 * axis + 1] = this->Grid.Planes[axis].back();
      }
    }
    mesh.Assign(std::move(points), std::move(faces));
    mesh.FindStrata();
    return mesh;
  }

  const DualGrid& Grid;
  int Rows; ///< of cells in a layer
  std::array<bool, 256> IsPlain;
  std::vector<Slab> Slabs;
};
}

InterfaceMesh MakeDualMesh(const DualGrid& grid, Executor& executor)
{
  return DualMesher(grid).Make(executor);
}
}
