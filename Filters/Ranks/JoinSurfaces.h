// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJoinSurfaces_h
#define volumicJoinSurfaces_h

#include <vtkSmartPointer.h>

#include <vector>

class vtkPolyData;

namespace volumic
{
/** What is no ghost in a piece. */
vtkSmartPointer<vtkPolyData> OwnPartOf(vtkPolyData* piece);

/**
 * A surface, or points, of which each rank has a piece. Of polygons, points at the borders of
 * pieces become one: those of the same global id, which then come in its order, or else those
 * nearer than 1e-6 of the surface's size. What several ranks have alike counts once; where the
 * first rank has all, it is as given.
 * @param given by rank; those that are null are none
 */
vtkSmartPointer<vtkPolyData> JoinSurfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& given);
}

#endif
