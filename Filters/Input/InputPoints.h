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

// The points of vtkDeformableSurface, from input ports and from lists of positions: seeds,
// attracting points, and points that select components. Results are in computational space. The
// points of poly data are the points of its vertex cells, or all points if there are no cells.

namespace volumic
{
/** Return the seeds of port 1. @throws InvalidArgument if it has polygons or lines only */
std::vector<Point> SeedsOf(vtkPolyData* port1, const ComputationalSpace& space);

/**
 * Return the attracting points of port 2, with the optional point arrays `Weight` and `Radius`
 * (world units).
 * @param size voxels of level 0 along each axis
 * @throws InvalidArgument for cells without vertices, a point outside the image, an array that is
 *   not numeric with one component, or a negative or infinite weight or radius
 */
std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* port2, const ComputationalSpace& space, const std::array<int, 3>& size);

/**
 * Return the points of both ports by which components are selected. A surface at port 1 has none.
 * @throws InvalidArgument for lines without vertices
 */
std::vector<Point> SelectionPositions(
  vtkPolyData* port1, vtkPolyData* port2, const ComputationalSpace& space);

/**
 * Transform positions from world coordinates. Move positions that are outside the box of the image
 * by less than a voxel onto it, such as positions that were picked on the border.
 * @param label label of the property, for messages
 * @param size  voxels of level 0 along each axis
 * @throws InvalidArgument for a position farther outside, or one that is not finite
 */
std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label,
  const ComputationalSpace& space, const std::array<int, 3>& size);

/** Return why VTK crashes with these cells, to follow a name, or an empty string. */
std::string FindInvalidCells(vtkPolyData* data);
}

#endif
