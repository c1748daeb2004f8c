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
  Even, ///< With even triangles; that it does not intersect itself must be asked.
  Safe  ///< Free of intersections; edges may be shorter than eq. (1) allows.
};

/** Result of FindMissedParts. */
struct RecoverySurfaces
{
  int Found = 0;           ///< Parts that the surface has lost.
  int Enclosed = 0;        ///< How many of them the surface below encloses, at least partly.
  IndexedSurface Surface;  ///< Closed, manifold, inward for cavities; workspace.
  MissedBoundary Boundary; ///< The boundary of all that were found.
  bool IsStopped = false;  ///< The answer was to stop: nothing is told, there is no surface.
};

/**
 * Looks for what coarser levels have lost (Documentation/differences.md): connected sets of at
 * least `minimumSize` voxels on the object's side outside the surface, or on the other side
 * inside it, all farther than two units of the level from any vertex; and encloses them with a new
 * surface, which then shrinks onto them as the first one did onto the object.
 *
 * It lies about .4 voxel beyond the isopotential, and keeps clear of the surface as it is
 * (DistanceLattice), with edges that respect eq. (1). Seeds inside the parts, as the paper starts
 * from, would have to grow through places that are too thin for them, and merge with holes left
 * between them.
 *
 * Inside is found by parity along rows of voxels, so the cost is O(voxels + triangles). The grid
 * of the state must be up to date, and no edge longer than 2.5 delta.
 */
RecoverySurfaces FindMissedParts(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, RecoveryShape shape, Executor& executor,
  const ProgressCallback& goOn = NeverStop);
}

#endif
