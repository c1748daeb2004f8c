// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCoreWrongVoxels_h
#define volumicCoreWrongVoxels_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Labels/LabelBricks.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The voxels of the map, sorted, whose centres a closed surface about an object has on the wrong
 * side: its own outside, others inside.
 * @param surface in coordinates in which voxel (i, j, k) of the map is at (i, j, k)
 * @param within  voxels elsewhere are nobody's
 */
std::vector<std::int64_t> FindWrongVoxels(
  const LabelBricks& bricks, int object, const IndexedSurface& surface, const VoxelBox& within);

/**
 * Those of the wrong voxels that are further than a tolerance from the surface, in smallest
 * distances of voxels.
 */
std::vector<std::int64_t> FindMissedVoxels(const LabelMap& map,
  const std::vector<std::int64_t>& wrong, const IndexedSurface& surface, double tolerance);
}

#endif
