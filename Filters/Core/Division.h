// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDivision_h
#define volumicDivision_h

#include "SurfaceMesh.h"

#include <vector>

namespace volumic
{
/**
 * Global division with factor sqrt 3 (the paper's section 5.1; L. Kobbelt has published the same
 * refinement as "sqrt(3)-subdivision", SIGGRAPH 2000, with a rule that smooths the old vertices,
 * which here stay where they are): a new vertex at the centre of every face, joined to its
 * corners; then every edge between two old vertices is flipped. Vertices become three times as
 * many, edges sqrt 3 times shorter. Old vertices keep index and valence, new ones have 6; chi
 * stays.
 *
 * The flips cut convex edges off and fill concave ones. Where the caller finds that this makes
 * the surface intersect itself it flips edges between new vertices back with EdgeFlip: with all
 * of them flipped back the surface is the old one.
 *
 * @return index of the first new vertex. `mesh` must have no free places.
 */
int Divide(SurfaceMesh& mesh);
}

#endif
