// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceCheck_h
#define volumicSurfaceCheck_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/SelfIntersections.h"

namespace volumic
{
/**
 * Check that a surface can be evolved: it must not be empty, and must be closed, manifold,
 * consistently oriented outward, properly nested and free of self-intersections. Indices and
 * coordinates must be valid. The surface may be in any space.
 * @throws std::invalid_argument with a message that names the defect, its number and the remedy
 */
void CheckInitialSurface(const IndexedSurface& surface);
}

#endif
