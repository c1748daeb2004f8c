// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLatticeSurface_h
#define volumicLatticeSurface_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <functional>

namespace volumic
{
/**
 * Remesh a closed surface on a cubic lattice (DistanceLattice), whatever its triangles look like:
 * slivers, fans of any valence, triangles of any size. Lattice points with a positive winding
 * number are inside.
 *
 * The result is a closed manifold without intersections. Vertices lie near the surface where it is smooth, and nowhere further from it than the pitch.
 * Parts thinner than the pitch may be lost or torn, and narrower gaps closed. Sharp edges are cut
 * off by up to half of the pitch.
 *
 * @param pitch distance of the lattice points, in the unit of the surface's points.
 * @param attempt number of the lattice's direction (ObliqueRotation): what one tears, another may not.
 * @param goOn receives the finished share now and then; if it returns false, the result is empty.
 * @return a surface without triangles if the lattice resolves no part of it.
 * `surface` must be closed and oriented.
 */
IndexedSurface RemeshOnLattice(const IndexedSurface& surface, double pitch, int attempt,
  Executor& executor, const std::function<bool(double share)>& goOn);
}

#endif
