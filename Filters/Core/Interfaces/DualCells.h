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
/** A cell that is not plain (CellPattern). Points are indices into its slab; -1: none. */
struct SpecialCell
{
  CellPattern Pattern;
  std::array<LabelMap::Number, 8> Labels;
  std::array<int, 3> At;
  std::array<int, 4> Apex;                       ///< point of each sheet
  std::array<std::array<int, 2>, 6> Strand;      ///< points of the strands that this cell owns
  std::array<std::array<int, 2>, 6> InnerStrand; ///< copies of the strands of opened sheets
  std::array<int, 12> InnerArc;                  ///< points on the arcs of opened sheets

  /** Return the copy of the strand of an edge on its side n (CellPattern::SidesOf). */
  int InnerStrandAt(int edge, int n) const
  {
    return this->InnerStrand[CellPattern::SidesOf(edge)[n]][this->Pattern.StrandOf[edge][n]];
  }
};

/** Consecutive layers of cells with their points and triangles. */
struct DualSlab
{
  int First = 0;
  int End = 0;
  std::vector<std::size_t> Row; ///< first crossed cell of each row of cells, y fastest
  std::vector<int> X;           ///< x index of each crossed cell
  std::vector<int> Contents;    ///< point of each crossed cell, or -1 - index of a special cell
  std::vector<SpecialCell> Special;
  std::vector<Vector> Points;
  /** Vertices are points of this slab; a negative v means point -1 - v of the previous slab. */
  std::vector<InterfaceMesh::Face> Faces;
};

/** The cells that interfaces cross, and their points (used by MakeDualMesh). */
class DualCells
{
public:
  static constexpr int SlabSize = 16; ///< layers of cells per slab, the unit of work of a thread

  /** @param grid must outlive this object */
  explicit DualCells(const DualGrid& grid);

  void Make(Executor& executor);

  /** Return whether a pattern of two labels is plain. @param bits octants of the lower rank */
  static bool IsPlainPattern(unsigned bits);

  const DualGrid& Grid;
  const int Rows; ///< rows of cells per layer
  std::vector<DualSlab> Slabs;

  std::size_t SliceSize() const
  {
    return static_cast<std::size_t>(this->Grid.Size[0]) * this->Grid.Size[1];
  }
  bool IsOutside(LabelMap::Number label) const
  {
    return this->Grid.Outside >= 0 && label == this->Grid.Outside;
  }
  /** Return whether the points of a cell lie in a side of the box normal to an axis. */
  bool IsAtSide(const std::array<int, 3>& cell, int axis) const
  {
    return this->Grid.Outside >= 0 && (cell[axis] == 0 || cell[axis] == this->Grid.Size[axis] - 2);
  }

private:
  using Number = LabelMap::Number;
  using LocalPoint = std::array<double, 3>; ///< coordinates in a cell, from 0 to 1

  void FindCells(DualSlab& slab) const;
  /** @param vertex position of the point if the cell is plain */
  void AddCell(DualSlab& slab, const std::array<int, 3>& at, const std::array<Number, 8>& labels,
    const LocalPoint& vertex) const;
  /** Return whether a cell has two labels in a plain pattern: the fast test for most cells. */
  bool IsPlainPair(const std::array<Number, 8>& labels) const;
  float CoordinateOf(const std::array<int, 3>& cell, int axis, double at) const;
  Vector PositionOf(const std::array<int, 3>& cell, const LocalPoint& at) const;
  /** Return whether a cell is at a side of the box and this side of the cell is the inner one. */
  bool IsOppositeToSide(const std::array<int, 3>& cell, int side) const
  {
    return this->IsAtSide(cell, side / 2) && ((side & 1) == 1) == (cell[side / 2] == 0);
  }
  void AddPointsOfSpecials(DualSlab& slab) const;
  bool IsSpecial(const std::array<int, 3>& cell) const;
};
}

#endif
