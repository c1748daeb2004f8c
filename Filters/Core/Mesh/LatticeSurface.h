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
 * Another mesh of a closed surface, whatever the triangles of that look like: slivers, fans of any
 * valence, triangles of any size.
 *
 * What it encloses is asked for at the points of a body-centred cubic lattice. Its tetrahedra with
 * points on both sides are cut by a triangle or two each, with corners on the edges that have one
 * end on either side. So the result is a closed oriented manifold surface that does not intersect
 * itself by construction. No edge is as long as the pitch, none shorter than a tenth of it, and no
 * vertex has more than 12 neighbours. Corners lie on the surface where it is smooth, and nowhere
 * further from it than the pitch; parts thinner than the pitch may be lost or torn, gaps narrower
 * than it closed, and where two sheets join at a sharp angle holes may stay open between them.
 *
 * @param pitch side of the lattice's cubes, in the unit of the points.
 * @param attempt which of ObliqueRotation::Count directions the lattice has: what one tears,
 * another may not.
 * @param goOn told the share that is done now and then; when it says no the result is empty.
 * @return with no triangles also where everything is thinner than the lattice resolves.
 * `surface` must be closed and oriented, and the boundary of a volume.
 */
IndexedSurface RemeshOnLattice(const IndexedSurface& surface, double pitch, int attempt,
  Executor& executor, const std::function<bool(double share)>& goOn);
}

#endif
