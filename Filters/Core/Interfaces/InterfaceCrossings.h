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
struct InterfaceCrossings
{
  std::vector<std::array<int, 2>> Pairs; ///< pairs of intersecting faces
  std::vector<int> Candidates;           ///< sorted faces in cubes with more than one sheet
};

/**
 * Find all pairs of intersecting faces. Pairs are tested in cubes of a few edge lengths. A cube is
 * skipped if its faces form one sheet: they separate the same two objects and have similar normals.
 * A line along the mean normal then crosses at most one of them, unless faces are inverted. Callers
 * must reject inverted faces before.
 * @param tolerance triangles at a smaller distance count as intersecting
 */
InterfaceCrossings FindCrossings(const InterfaceMesh& mesh, double tolerance, Executor& executor);
}

#endif
