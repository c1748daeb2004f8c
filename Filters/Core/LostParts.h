// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLostParts_h
#define volumicLostParts_h

#include "Field.h"
#include "SurfaceState.h"

#include <vector>

namespace volumic
{
/** Result of FindLostParts. */
struct LostPartSeeds
{
  int Found = 0;              ///< Parts of the object that the surface has lost.
  int Seeded = 0;             ///< Of them, those that got a seed.
  std::vector<Point> Centres; ///< Workspace.
};

/**
 * Looks for what coarser levels have lost (method.md section 10, last paragraph): connected sets
 * of at least `minimumSize` voxels on the object's side that are neither inside the surface nor
 * within two voxels of a vertex. Each gets seeds, best voxels first, at least 4 delta from each
 * other, where an icosahedron of `radius` can touch nothing.
 *
 * Inside is found by parity along rows of voxels, so the cost is O(voxels + triangles). The grid
 * of the state must be up to date, and no edge longer than 2.5 delta.
 */
LostPartSeeds FindLostParts(
  const SurfaceState& state, const Field& field, int minimumSize, double radius);
}

#endif
