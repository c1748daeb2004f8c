// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMissedParts_h
#define volumicMissedParts_h

#include "Core/Common/Monitor.h"
#include "Core/Evolution/MissedBoundary.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

namespace volumic
{
enum class RecoveryShape
{
  Even, ///< well-shaped triangles; may intersect itself
  Safe  ///< free of intersections; edges may be shorter than eq. (1) allows
};

/** Result of FindMissedParts(). */
struct RecoverySurfaces
{
  int Found = 0;           ///< number of missed parts
  int Enclosed = 0;        ///< parts that Surface encloses, at least partly
  IndexedSurface Surface;  ///< closed, manifold; oriented inward for cavities
  MissedBoundary Boundary; ///< of all missed parts
  bool IsStopped = false;  ///< cancelled: there is no result
};

/**
 * Find the parts that coarser levels have missed (Documentation/differences.md), and create
 * recovery surfaces around them. Missed parts are connected sets of at least `minimumSize` object
 * voxels outside the surface (or background voxels inside), all farther than two units from any
 * vertex.
 *
 * Recovery surfaces lie about 0.4 voxel outside the isosurface, with a clearance to the existing
 * surface (DistanceLattice). Edges respect eq. (1). Seeds inside the parts, as in the paper, cannot
 * grow through thin regions, and leave holes where they merge.
 *
 * The cost is O(voxels + triangles), by parity along rows of voxels. The grid of the state must be
 * up to date, and no edge longer than 2.5 delta.
 */
RecoverySurfaces FindMissedParts(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, RecoveryShape shape, Executor& executor,
  const ProgressCallback& goOn = NeverStop);
}

#endif
