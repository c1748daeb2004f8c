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
/** A voxel whose centre is in different objects in the mesh and in the map. */
struct MismatchedVoxel
{
  std::array<int, 3> At;
  LabelMap::Number MapObject;
  LabelMap::Number MeshObject;
  bool IsFar = true; ///< Whether it is further from the interfaces than the tolerance.
};

/**
 * Find the misclassified voxels of a box, x fastest. Voxels outside the map are background.
 * @param step      size of a voxel in computational space
 * @param tolerance distance in computational space, see MismatchedVoxel::IsFar
 */
std::vector<MismatchedVoxel> FindMismatchedVoxels(const InterfaceMesh& mesh, const LabelMap& map,
  const VoxelBox& box, const std::array<double, 3>& step, double tolerance, Executor& executor);
}

#endif
