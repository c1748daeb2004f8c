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
/** What FindCrossings() has found. */
struct InterfaceCrossings
{
  std::vector<std::array<int, 2>> Pairs; ///< of faces that intersect
  std::vector<int> Doubtful;             ///< faces that are not in one sheet with all near, sorted
};

/**
 * All pairs of faces that intersect. Space is cut into cubes, a few edges wide. Where the faces in a
 * cube are all between the same two objects, and face about one way, a line that way passes at most
 * one of them: between two that face alike there is one that faces the other way, unless one has
 * been turned over, which is to be looked at before. Only elsewhere pairs are tested.
 * @param tolerance triangles nearer than that count as intersecting
 */
InterfaceCrossings FindCrossings(const InterfaceMesh& mesh, double tolerance, Executor& executor);
}

#endif
