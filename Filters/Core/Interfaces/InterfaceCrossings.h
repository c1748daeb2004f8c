// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceCrossings_h
#define volumicInterfaceCrossings_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <array>
#include <vector>

namespace volumic
{
/** Result of FindCrossings(). */
struct InterfaceCrossings
{
  std::vector<std::array<int, 2>> Pairs; ///< pairs of intersecting faces
  std::vector<int> Candidates;           ///< sorted faces in cubes with more than one sheet
};

/**
 * Find all pairs of intersecting faces. Space is divided into cubes of a few edge lengths. Faces in
 * a cube that separate the same two objects and have similar normals form one sheet and cannot
 * intersect: a line along the normal crosses at most one of them. Other pairs in a cube are tested.
 * Callers must reject inverted faces before, as the argument does not hold for them.
 * @param tolerance triangles at a smaller distance count as intersecting
 */
InterfaceCrossings FindCrossings(const InterfaceMesh& mesh, double tolerance, Executor& executor);
}

#endif
