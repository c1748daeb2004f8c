// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDualCells_h
#define volumicDualCells_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/CellPattern.h"
#include "Core/Interfaces/DualMesh.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/** A cell that is not plain (CellPattern). Points: of its slab; -1: it has none. */
struct SpecialCell
{
  CellPattern Pattern;
  std::array<LabelMap::Number, 8> Labels;
  std::array<int, 3> At;
  std::array<int, 4> Apex;                       ///< of each sheet
  std::array<std::array<int, 2>, 6> Strand;      ///< where they are those of this cell
  std::array<std::array<int, 2>, 6> InnerStrand; ///< of opened sheets, the copies
  std::array<int, 12> InnerArc;

  /** The copy of an arc's strand on one of its edge's two sides (CellPattern::SidesOf). */
  int InnerStrandAt(int edge, int n) const
  {
    return this->InnerStrand[CellPattern::SidesOf(edge)[n]][this->Pattern.StrandOf[edge][n]];
  }
};

/** Some layers of cells, and the voxel faces and special cells in them. */
struct DualSlab
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

/** The cells of a grid that interfaces pass through, and their points: for MakeDualMesh(). */
class DualCells
{
public:
  static constexpr int SlabSize = 16; ///< layers of cells that a thread makes at a time

  /** The grid must outlive it. */
  explicit DualCells(const DualGrid& grid);

  /** Finds the cells, and makes the points in them. */
  void Make(Executor& executor);

  /** Whether a pattern of two labels, bits of the octants of earlier rank, is plain. */
  static bool IsPlainPattern(unsigned bits);

  const DualGrid& Grid;
  const int Rows; ///< of cells in a layer
  std::vector<DualSlab> Slabs;

  std::size_t SliceSize() const
  {
    return static_cast<std::size_t>(this->Grid.Size[0]) * this->Grid.Size[1];
  }
  bool IsOutside(LabelMap::Number label) const
  {
    return this->Grid.Outside >= 0 && label == this->Grid.Outside;
  }
  /** Whether a cell has its points in one plane across an axis, at the side of a box. */
  bool IsAtSide(const std::array<int, 3>& cell, int axis) const
  {
    return this->Grid.Outside >= 0 && (cell[axis] == 0 || cell[axis] == this->Grid.Size[axis] - 2);
  }

private:
  using Number = LabelMap::Number;
  using Place = std::array<double, 3>; ///< in a cell, from 0 to 1

  void FindCells(DualSlab& slab) const;
  /** @param vertex where it is if the cell is plain */
  void AddCell(DualSlab& slab, const std::array<int, 3>& at, const std::array<Number, 8>& labels,
    const Place& vertex) const;
  /** Whether there are two labels, in a pattern that is plain: most cells, and quickly found. */
  bool IsPlainPair(const std::array<Number, 8>& labels) const;
  float CoordinateOf(const std::array<int, 3>& cell, int axis, double at) const;
  Vector IjkOf(const std::array<int, 3>& cell, const Place& at) const;
  /** Whether a cell is at the side of a box, with this one of its own sides within the box. */
  bool IsOppositeToSide(const std::array<int, 3>& cell, int side) const
  {
    return this->IsAtSide(cell, side / 2) && ((side & 1) == 1) == (cell[side / 2] == 0);
  }
  void AddPointsOfSpecials(DualSlab& slab) const;
  bool IsSpecial(const std::array<int, 3>& cell) const;
};
}

#endif
