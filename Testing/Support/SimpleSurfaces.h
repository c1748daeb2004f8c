// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** Small surfaces with known verdicts, as input for tests. */

#ifndef volumicSimpleSurfaces_h
#define volumicSimpleSurfaces_h

#include "TriangleSurface.h"

namespace volumic::support
{

/**
 * The corner of a cube with edges of length `size` at `at`. A negative size mirrors it at `at`,
 * which turns it inside out.
 */
TriangleSurface Tetrahedron(double size = 1.0, const std::array<double, 3>& at = { 0.0, 0.0, 0.0 });

/**
 * A ring around the z axis: n x m quads, each cut in two; `major` from the axis to the middle of
 * the tube, `minor` the radius of the tube.
 */
TriangleSurface Torus(int n, int m, double major, double minor);

/**
 * An open sheet of n x n squares of side 1, each cut in two, from the origin in the plane z =
 * height, with its normals along z.
 */
TriangleSurface Sheet(int n, double height);

/** The same surface with inside and outside exchanged. */
TriangleSurface Reversed(TriangleSurface surface);

/** Adds the points and triangles of another surface. */
void Append(TriangleSurface& to, const TriangleSurface& from);

} // namespace volumic::support

#endif
