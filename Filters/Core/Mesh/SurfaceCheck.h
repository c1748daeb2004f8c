// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceCheck_h
#define volumicSurfaceCheck_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/SelfIntersections.h"

namespace volumic
{
/**
 * Refuses a surface that can't be evolved: empty, indices or coordinates out of range, open, not
 * manifold, not oriented, inside out, not the boundary of a volume (components nested the wrong
 * way), self-intersecting. `surface` may be in any space.
 * @throws std::invalid_argument whose message names what is wrong, how often, and the way out.
 */
void CheckInitialSurface(const IndexedSurface& surface);
}

#endif
