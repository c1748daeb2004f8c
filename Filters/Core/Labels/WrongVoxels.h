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
 */
std::vector<std::int64_t> FindWrongVoxels(
  const LabelBricks& bricks, int object, const IndexedSurface& surface);

/**
 * Those of the wrong voxels that are further than a tolerance from the surface, in smallest distances
 * of voxels.
 */
std::vector<std::int64_t> FindMissedVoxels(const LabelMap& map,
  const std::vector<std::int64_t>& wrong, const IndexedSurface& surface, double tolerance);

/**
 * Voxels of the largest part of an object, joined by faces, that its surface has left out. Those
 * beside a voxel that it has inside don't count: what is cut off along a ridge is no part.
 * @param wrong what FindWrongVoxels() has found
 */
std::int64_t SizeOfLargestLostPart(
  const LabelMap& map, int object, const std::vector<std::int64_t>& wrong);
}

#endif
