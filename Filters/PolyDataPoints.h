// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPolyDataPoints_h
#define volumicPolyDataPoints_h

#include <vtkType.h>

#include <vector>

class vtkPolyData;

namespace volumic
{
/**
 * The points that are meant by a poly data where points are asked for, seeds as well as points known
 * to belong to the object: those of its vertices (cells of the list Verts), each once, in their
 * order; all its points where it has no cells at all. Other cells beside vertices do not count.
 * @throws std::invalid_argument if it has cells, but no vertices: nothing says that the points of
 *         a line or of a surface are meant.
 */
std::vector<vtkIdType> PointsMeantBy(vtkPolyData* polyData);

/// Whether it has polygons and no vertices: then it is a surface, and no points are meant.
bool IsSurfaceOnly(vtkPolyData* polyData);
}

#endif
