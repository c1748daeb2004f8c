// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleTests_h
#define volumicTriangleTests_h

#include "Core/Common/Vector.h"

namespace volumic
{
/** Triangle with the indices of its vertices, which identify shared corners. */
struct MeshTriangle
{
  int Vertex[3];
  VectorD Corner[3];
};

class SurfaceMesh;

MeshTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c);

/**
 * Return whether two triangles of a mesh intersect apart from the corners or the edge they share.
 *
 * Coordinates must be exact in float. The test is conservative: triangles nearer than about
 * `tolerance` (a length) count as intersecting, so a negative result remains valid after the
 * rounded transform to world coordinates. Triangles that share an edge intersect if they are folded
 * onto each other to within about one degree.
 */
bool TrianglesIntersect(const MeshTriangle& f, const MeshTriangle& g, double tolerance);
}

#endif
