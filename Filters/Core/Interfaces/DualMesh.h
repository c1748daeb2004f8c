// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDualMesh_h
#define volumicDualMesh_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Labels/LabelMap.h"

#include <array>
#include <functional>
#include <vector>

namespace volumic
{
/** Labels on a rectilinear grid: input of MakeDualMesh(). Lengths are in computational space. */
struct DualGrid
{
  std::array<int, 3> Size; ///< number of voxels; all outermost voxels have label 0 or Outside
  std::array<std::vector<float>, 3> Centres; ///< coordinates of voxel centres along each axis
  std::array<std::vector<float>, 3> Planes;  ///< coordinates of the faces between voxels
  /** Rank of each label. Of two labels at a voxel edge, the one of lower rank is connected. */
  std::vector<int> RankOf;
  /** Label outside the box and number of its first side (InterfaceMesh::FirstSide); -1: no box. */
  int Outside = -1;
  /** Write the labels of a slice, x fastest. Called by several threads. */
  std::function<void(int k, LabelMap::Number* labels)> CopySlice;
  /**
   * Write the values of the function whose signs are the labels (optional). Vertices of plain cells
   * are then the mean of its zeros on the cell edges instead of the centre.
   */
  std::function<void(int k, float* values)> CopyValues;
  /** Whether to cut voxel faces along the shorter diagonal. Triangles may then intersect. */
  bool HasShortDiagonals = false;
};

/**
 * Create the interfaces of labels with the topology of their voxels: the dual mesh of the voxel
 * faces. The method extends constrained elastic surface nets (Gibson 1998) and is not in the paper.
 * Each sheet of a cell has its own vertex (CellPattern), so that all surfaces are manifolds. A
 * voxel face with four plain cells becomes two triangles. Other voxel faces become fans around
 * their centres, with a vertex for each strand.
 *
 * A label is connected
 * - through voxel faces;
 * - through a voxel edge with two opposite voxels of the label, if the two other voxels have
 *   different labels or one label of higher rank;
 * - through a voxel corner in one pattern only: four labels, each at two opposite corners of a
 *   cell. The label of the lowest rank is then connected.
 *
 * The surface of each label is a closed manifold, and no triangles intersect. Vertices at the sides
 * of a box lie in the planes of these sides.
 *
 * The boundary loop of an opened sheet (CellPattern::IsOpened) on the sides of the cell is copied
 * at half the size around the centre of the cell. Polygons connect both loops. A fan closes each
 * region except for the one at the centre.
 */
InterfaceMesh MakeDualMesh(const DualGrid& grid, Executor& executor);

/** Create the points and triangles of MakeDualMesh() only. */
void MakeDualFaces(const DualGrid& grid, Executor& executor, LargeVector<Vector>& points,
  LargeVector<InterfaceMesh::Face>& faces);
}

#endif
