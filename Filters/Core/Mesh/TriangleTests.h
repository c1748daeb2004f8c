// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleTests_h
#define volumicTriangleTests_h

#include "Core/Common/Vector.h"

namespace volumic
{
/** A triangle with the names of its corners, so that shared corners are recognised. */
struct NamedTriangle
{
  int Name[3];
  VectorD Corner[3];
};

/**
 * Whether two triangles of one mesh meet anywhere but in the corners or the edge they share.
 *
 * Coordinates must come from floats. The test errs on the safe side: triangles that come nearer
 * than about `tolerance` (a length) count as meeting, so a "no" also survives the rounding of a
 * later map to world coordinates. Two that share an edge meet when they are folded onto each other
 * to within a degree.
 */
bool TrianglesIntersect(const NamedTriangle& f, const NamedTriangle& g, double tolerance);
}

#endif
