// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMismatchedVoxels_h
#define volumicMismatchedVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Labels/LabelBricks.h"

#include <array>
#include <vector>

namespace volumic
{
/** A voxel whose centre a mesh has in another object than the map. */
struct MismatchedVoxel
{
  std::array<int, 3> At;
  LabelMap::Number OfMap;
  LabelMap::Number OfMesh;
};

/**
 * The voxels with their centres on the wrong side of interfaces, in the order of the map, in which
 * voxels are counted (LabelBricks::Inside).
 * @param step      lengths of a voxel in the workspace
 * @param tolerance those no further from the interfaces than that are left out; workspace
 */
std::vector<MismatchedVoxel> FindMismatchedVoxels(const InterfaceMesh& mesh,
  const LabelBricks& bricks, const std::array<double, 3>& step, double tolerance,
  Executor& executor);
}

#endif
