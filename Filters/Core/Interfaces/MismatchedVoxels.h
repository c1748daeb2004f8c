// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMismatchedVoxels_h
#define volumicMismatchedVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Labels/LabelMap.h"

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
  bool IsFar = true; ///< further from the interfaces than the tolerance
};

/**
 * The voxels of a box with their centres on the wrong side of interfaces, in their order.
 * @param step      lengths of a voxel in the workspace
 * @param tolerance workspace
 */
std::vector<MismatchedVoxel> FindMismatchedVoxels(const InterfaceMesh& mesh,
  const LabelMap& map, const VoxelBox& box, const std::array<double, 3>& step, double tolerance,
  Executor& executor);
}

#endif
