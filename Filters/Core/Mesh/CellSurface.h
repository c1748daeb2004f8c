// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCellSurface_h
#define volumicCellSurface_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Lattice.h"

#include <vector>

namespace volumic
{
/**
 * Space filled with truncated octahedra, all of one edge length (workspace). Four of them
 * share a corner and three an edge, each two of those a face: so the boundary of any set of cells
 * is a closed manifold surface without self-intersections, whatever the set looks like.
 *
 * A cell has three indices that are all even or all odd; its centre lies at sqrt 2 times the edge
 * length times the indices.
 */
class CellLattice
{
public:
  using Cell = LatticePoint;
  static constexpr int NumberOfCorners = 24;
  /** Distance of the corners from the centre, in edge lengths: sqrt(5/2). */
  static constexpr double Circumradius = 1.5811388300841898;

  explicit CellLattice(double edge);

  /** The cell that holds a point. */
  Cell CellAt(const Point& place) const;
  Point Centre(const Cell& cell) const;
  Point Corner(const Cell& cell, int index) const;

  /**
   * The boundary of a set of cells, outward oriented. Squares are cut along a diagonal and
   * hexagons fanned about their centre, so that edges have 1 or sqrt 2 times the edge length, and
   * corners that are not joined by one keep at least the edge length from each other.
   * `cells` must be sorted and without repetition.
   */
  IndexedSurface Boundary(
    const std::vector<Cell>& cells, Executor& executor = OnThisThread()) const;

private:
  double Scale; ///< Workspace length of the unit in which corners have integer coordinates.
};
}

#endif
