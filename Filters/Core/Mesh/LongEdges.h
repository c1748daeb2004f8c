// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLongEdges_h
#define volumicLongEdges_h

#include "Core/Common/IndexedSurface.h"

namespace volumic
{
/**
 * Halves the edges of a closed manifold that are longer than this, and their triangles with them,
 * until none is. The surface stays where it is: what does not intersect itself does not afterwards,
 * but for the rounding of the new points.
 */
void HalveLongEdges(IndexedSurface& surface, double longest);
}

#endif
