// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInputPoints_h
#define volumicInputPoints_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Image/PointAttraction.h"
#include "Input/ComputationalSpace.h"

#include <vtkType.h>

#include <array>
#include <string>
#include <vector>

class vtkPolyData;

// The points that are given to vtkDeformableSurface, by input ports and by lists, and what they are
// for: seeds, attraction, and the choice of components.

namespace volumic
{
/**
 * Port 1 as centres of seeds: the points that it means, in the workspace.
 * @throws std::invalid_argument if it has polygons or lines only.
 */
std::vector<Point> SeedsOf(vtkPolyData* port1, const ComputationalSpace& space);

/**
 * Port 2 as points known to belong to the object: those that it means; point arrays `Weight` and
 * `Radius` (world units), both optional.
 * @param size voxels of level 0 along each axis
 * @throws std::invalid_argument for cells without vertices, a point outside the image, an array
 *         that is not numbers of one component, a negative or infinite weight or radius.
 */
std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* port2, const ComputationalSpace& space, const std::array<int, 3>& size);

/**
 * Both ports as places that components are chosen by: the points that they mean, in the workspace,
 * but for a surface at port 1, which means none.
 * @throws std::invalid_argument for other cells without vertices.
 */
std::vector<Point> SelectionPositions(
  vtkPolyData* port1, vtkPolyData* port2, const ComputationalSpace& space);

/**
 * A list of positions (world coordinates), in the workspace. One that is out of the box of the
 * image by less than a voxel, as one that was picked on its border may be, is moved onto the box.
 * @param label of the property, for messages
 * @param size  voxels of level 0 along each axis
 * @throws std::invalid_argument for a position farther outside, or one that is not finite.
 */
std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label,
  const ComputationalSpace& space, const std::array<int, 3>& size);

/**
 * What is wrong with the cells of data that come from elsewhere, as words behind a name: their
 * points are others than those that are there, at which VTK's filters end the program. Empty:
 * nothing.
 */
std::string FaultOfCells(vtkPolyData* data);
}

#endif
