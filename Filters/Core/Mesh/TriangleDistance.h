// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleDistance_h
#define volumicTriangleDistance_h

#include "Core/Common/Vector.h"
#include "Core/Mesh/TriangleTests.h"

namespace volumic
{
/** Return the squared distance from a point to a triangle, given by its three corners. */
double SquaredDistanceToTriangle(const VectorD& point, const VectorD* triangle);

/**
 * Return the squared distance of two triangles of a mesh apart from their common vertices: the
 * least distance between a corner of one that is not in the other and that other triangle, or
 * between two edges without a common end.
 */
double SquaredGapBetween(const MeshTriangle& f, const MeshTriangle& g);
}

#endif
