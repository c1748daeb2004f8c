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
/** A map of labels, or of the two sides of a surface, and where its voxels are. */
struct DualGrid
{
  std::array<int, 3> Size; ///< voxels; the outermost ones are all of 0, or all of Outside
  std::array<std::vector<float>, 3> Centres; ///< of voxels, along each axis; workspace
  std::array<std::vector<float>, 3> Planes;  ///< of faces, that after each voxel but the last one
  /** Of each label: of two that meet across a voxel edge that of the lower rank holds together. */
  std::vector<int> RankOf;
  /** What is about a box, and the number of its first side (InterfaceMesh::FirstSide); -1: none. */
  int Outside = -1;
  /** Writes the labels of a slice, x fastest; called by threads. */
  std::function<void(int k, LabelMap::Number* labels)> CopySlice;
  /**
   * Where labels are the signs of a function, its values. The vertices of plain cells are then at
   * the mean of its zeros on their edges, in place of the middle.
   */
  std::function<void(int k, float* values)> CopyValues;
  /** Voxel faces are cut along the shorter diagonal; triangles may intersect then. */
  bool HasShortDiagonals = false;
};

/**
 * The interfaces of labels with the topology of their voxels: the dual mesh of the voxel faces.
 * Not the paper's; after Gibson's constrained elastic surface nets (1998), whose vertices are split
 * here so that all surfaces are manifolds: a vertex in each sheet of each cell (CellPattern), and two
 * triangles for each voxel face whose four cells are plain. Other voxel faces are fans about their
 * centres, with a vertex for each strand.
 *
 * A label is connected through voxel faces; through a voxel edge, where its two voxels are opposite,
 * and the two others are of two labels, or of one of later rank; never through a voxel corner
 * alone, but for one pattern: four labels, each at two opposite corners of a cell, of which that of
 * first rank is connected. Each label's surface is closed, and a manifold, and no triangles
 * intersect.
 *
 * An opened sheet (CellPattern::IsOpened): its rim on the cell's sides is copied at half the size
 * about the cell's centre; polygons reach from the one to the other, and each region but that which
 * takes the centre is closed by a fan.
 *
 * At the sides of a box vertices are in their planes.
 */
InterfaceMesh MakeDualMesh(const DualGrid& grid, Executor& executor);

/** The triangles alone. */
void MakeDualFaces(const DualGrid& grid, Executor& executor, LargeVector<Vector>& points,
  LargeVector<InterfaceMesh::Face>& faces);
}

#endif
