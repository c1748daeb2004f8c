// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankInputs_h
#define volumicRankInputs_h

#include "Core/Common/Communicator.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace volumic
{
/**
 * Joins a surface, or points, of which each rank has a piece, at rank 0; all ranks call it. Ghosts
 * are left out. Of polygons, points at the borders of pieces become one: those of the same global
 * id, which then come in its order, or else those nearer than 1e-6 of the surface's size. Ranks
 * that have the same count once. With one rank, or where rank 0 has all, it is as given.
 * @param piece may be null
 * @return null at other ranks, and where no rank has one
 */
vtkSmartPointer<vtkPolyData> JoinPieces(Communicator& ranks, vtkPolyData* piece);
}

#endif
