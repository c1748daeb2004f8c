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
 * How the interfaces of labels pass through a cell, the cube between the centres of eight voxels.
 * Its corners, octants, are numbered by bits: 1 for the higher one along x, 2 along y, 4 along z.
 * An edge is crossed where its octants have two labels; that piece of a voxel face is an arc. Where
 * arcs cross the sides of the cell are strands:
 *
 * | labels about a side | strands |
 * |---|---|
 * | AAAB, AABB, AABC, ABCD | one |
 * | ABAC, ABAB with A before B in rank | two: A holds together across the voxel edge |
 *
 * Arcs that share a strand are a sheet, octants of one label that hold together a region. Only the
 * four labels of a side decide how it is crossed, so that both of its cells agree.
 */
class CellPattern
{
public:
  using Number = LabelMap::Number;
  static constexpr int Edges = 12;
  static constexpr int Sides = 6; ///< 2 times the axis across it, and 1 for the higher one
  static constexpr int Octants = 8;

  CellPattern() = default;
  /** @param rankOf of each label; of a lower rank it is that holds together */
  CellPattern(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);

  /** The edge along an axis with coordinates 0 or 1 along the two next axes (x after z). */
  static int EdgeAt(int axis, int first, int second) { return 4 * axis + first + 2 * second; }
  /** Its octants, the lower one first. */
  static std::array<int, 2> OctantsOf(int edge);
  /** Its sides: that across the next axis, and that across the one after. */
  static std::array<int, 2> SidesOf(int edge);

  /** One vertex, through which all of its polygons go; and its sides have a strand at most. */
  bool IsPlain() const { return this->Sheets == 1 && !this->HasJoins && this->Opened == 0; }

  std::array<signed char, Edges> SheetOf; ///< of each edge; -1: it is not crossed
  /** Of each edge which of the strands on each of its two sides, 0 or 1. */
  std::array<std::array<signed char, 2>, Edges> StrandOf;
  std::array<signed char, Sides> StrandsOn;
  std::array<signed char, Octants> RegionOf; ///< an octant of it
  int Sheets = 0;
  bool HasJoins = false; ///< a label holds together across a voxel edge

  /**
   * A sheet that two regions of one label touch cannot be one vertex, as this label's surface would
   * touch itself there: it is opened, which gives the centre of the cell to one region.
   */
  bool IsOpened(int sheet) const { return (this->Opened >> sheet & 1) != 0; }
  std::array<signed char, 4> CentreOf; ///< of opened sheets, an octant of the region

private:
  void FindArcs(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);
  void FindCentres(const std::array<Number, Octants>& labels, const std::vector<int>& rankOf);

  unsigned Opened = 0; ///< bits of sheets
};
}

#endif
