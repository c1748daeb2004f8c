// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleTests_h
#define volumicTriangleTests_h

#include "Core/Common/Vector.h"

namespace volumic
{
/** A triangle with the indices of its vertices, so that shared corners are recognised. */
struct MeshTriangle
{
  int Vertex[3];
  VectorD Corner[3];
};

class SurfaceMesh;

/** The triangle of three vertices, at their positions. */
MeshTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c);

/**
 * Whether two triangles of one mesh intersect anywhere but in the corners or the edge they share.
 *
 * Coordinates must come from floats. The test is conservative: triangles that come nearer
 * than about `tolerance` (a length) count as intersecting, so a "no" also survives the rounding of
 * a later map to world coordinates. Two that share an edge intersect when they are folded onto each
 * other to within about a degree.
 */
bool TrianglesIntersect(const MeshTriangle& f, const MeshTriangle& g, double tolerance);
}

#endif
