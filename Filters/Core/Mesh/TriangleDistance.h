// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleDistance_h
#define volumicTriangleDistance_h

#include "Core/Common/Vector.h"
#include "Core/Mesh/TriangleTests.h"

namespace volumic
{
/** From a place to the nearest point of a triangle, given by its three corners. */
double SquaredDistanceToTriangle(const VectorD& place, const VectorD* triangle);

/**
 * How near two triangles of one mesh come to each other where they have nothing in common: the
 * least distance of a corner of the one, which the other one has not, from that, or between two
 * edges without a common end.
 */
double SquaredGapBetween(const MeshTriangle& f, const MeshTriangle& g);
}

#endif
