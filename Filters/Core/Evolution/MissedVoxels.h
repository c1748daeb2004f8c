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
 * The voxels that a surface has lost: those on the object's side outside of it, or on the other
 * side inside of it, that are farther than NearUnits from any vertex. They are kept as runs; where
 * nothing is lost there is nothing to keep.
 */
struct MissedVoxels
{
  /** Runs that one thread looks at at a time. */
  static constexpr std::size_t RunSpan = 64;

  std::vector<VoxelRun> Runs; ///< In order.
  int Parts = 0; ///< Voxels that share a face are of one; in the order of their first voxels.
  bool IsStopped = false; ///< Then nothing is found.
};

/**
 * The image is searched in slabs of layers: inside is found by parity along rows, so the cost is
 * O(voxels + triangles). The state's edges must not be longer than its sizing allows.
 * @param minimumSize voxels; what has fewer is left out
 * @param goOn        told the share that is done now and then; once it says no nothing is found
 */
MissedVoxels FindMissedVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressCallback& goOn);
}

#endif
