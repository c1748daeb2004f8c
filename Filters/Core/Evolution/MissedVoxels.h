// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMissedVoxels_h
#define volumicMissedVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Common/Monitor.h"
#include "Core/Evolution/SlabSearch.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <vector>

namespace volumic
{
/**
 * Voxels missed by a surface: object voxels outside (or background voxels inside), farther than
 * NearUnits from any vertex. They are stored as runs.
 */
struct MissedVoxels
{
  /** Runs per span of a parallel loop. */
  static constexpr std::size_t RunSpan = 64;

  std::vector<VoxelRun> Runs; ///< in order
  int Parts = 0;              ///< face-connected parts, ordered by their first voxels
  bool IsStopped = false;     ///< cancelled: there is no result
};

/**
 * Find the voxels missed by a surface, by parity along rows of voxels, in O(voxels + triangles).
 * Edges must not be longer than the sizing field allows.
 * @param minimumSize smallest number of voxels of a part
 * @param goOn        progress callback; there is no result if it returns false
 */
MissedVoxels FindMissedVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressCallback& goOn);
}

#endif
