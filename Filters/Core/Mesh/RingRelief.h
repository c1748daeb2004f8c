// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRingRelief_h
#define volumicRingRelief_h

#include "Core/Common/IndexedSurface.h"

namespace volumic
{
/**
 * Flips edges of points that have more neighbours than a ring can take, as iso-surfaces of noise
 * have a few, until it can: each time the edge whose new triangles turn least from the old ones.
 * The surface stays closed and manifold; whether it intersects itself must be asked afterwards.
 * @return whether all rings can take their neighbours.
 */
bool RelieveRings(IndexedSurface& surface);
}

#endif
