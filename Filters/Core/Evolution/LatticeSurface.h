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
 * Remesh a closed, oriented surface on a cubic lattice (DistanceLattice). Its triangles may have
 * any shape, size and valence. Lattice points with a positive winding number are inside.
 *
 * The result is a closed manifold without intersections, at most the pitch away from the surface.
 * Parts thinner than the pitch may vanish or break, and narrower gaps may close. Sharp edges are
 * cut off by up to half of the pitch.
 *
 * @param pitch distance between lattice points
 * @param attempt index of the lattice's direction (ObliqueRotation); another one may keep thin
 * parts
 * @param goOn progress callback; the result is empty if it returns false
 * @return an empty surface if the lattice resolves no part of the surface
 */
IndexedSurface RemeshOnLattice(const IndexedSurface& surface, double pitch, int attempt,
  Executor& executor, const std::function<bool(double share)>& goOn);
}

#endif
