// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCellPattern_h
#define volumicCellPattern_h

#include "Core/Labels/LabelMap.h"

#include <array>
#include <vector>

namespace volumic
{
/**
 * Pattern of the label interfaces in a cell, the cube between the centres of eight voxels.
 *
 * - Octant: a corner of the cell, numbered by bits (1: high in x, 2: high in y, 4: high in z).
 * - Arc: the part of a voxel face in the cell. It crosses a cell edge between different labels.
 * - Strand: a point at which arcs leave the cell through a side. Their number by labels:
 *
 * | labels around a side | strands |
 * |---|---|
 * | AAAB, AABB, AABC, ABCD | one |
 * | ABAC, ABAB with A before B in rank | two: A is connected across the voxel edge |
 *
 * - Sheet: arcs connected by strands.
 * - Region: connected octants of one label.
 *
 * The crossing of a side depends on its four labels only, so that both adjacent cells agree.
 */
class CellPattern
{
public:
  using Number = LabelMap::Number;
  static constexpr int Edges = 12;
  static constexpr int Sides = 6; ///< side number: 2 * axis + (1 if it is the high side)
  static constexpr int Octants = 8;

  CellPattern() = default;
  /** @param rankOf rank of each label; the label of lower rank is connected across voxel edges */
  CellPattern(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);

  /** Return an edge along an axis, given its coordinates (0 or 1) along the next two axes. */
  static int EdgeAt(int axis, int first, int second) { return 4 * axis + first + 2 * second; }
  /** Return the octants of an edge, the lower one first. */
  static std::array<int, 2> OctantsOf(int edge);
  /** Return the sides that share an edge: normal to the next axis, and to the axis after it. */
  static std::array<int, 2> SidesOf(int edge);

  /** Whether one vertex represents the cell: one sheet, at most one strand per side, not opened. */
  bool IsPlain() const { return this->Sheets == 1 && !this->HasJoins && this->Opened == 0; }

  std::array<signed char, Edges> SheetOf; ///< sheet of each edge; -1: the edge is not crossed
  /** Strand (0 or 1) of each edge on each of its two sides. */
  std::array<std::array<signed char, 2>, Edges> StrandOf;
  std::array<signed char, Sides> StrandsOn;  ///< number of strands of each side
  std::array<signed char, Octants> RegionOf; ///< an octant that represents the region
  int Sheets = 0;
  bool HasJoins = false; ///< Whether a label is connected across a voxel edge.

  /**
   * Return whether a sheet is opened: the centre of the cell is given to one region. Otherwise the
   * surface of a label with two regions at the sheet would touch itself.
   */
  bool IsOpened(int sheet) const { return (this->Opened >> sheet & 1) != 0; }
  std::array<signed char, 4> CentreOf; ///< octant of the region at the centre of an opened sheet

private:
  void FindArcs(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);
  void FindCentres(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);

  unsigned Opened = 0; ///< one bit per sheet
};
}

#endif
