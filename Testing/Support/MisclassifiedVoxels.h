// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMisclassifiedVoxels_h
#define volumicMisclassifiedVoxels_h

#include "SyntheticScenes.h"
#include "TriangleSurface.h"

#include <array>
#include <vector>

namespace volumic::support
{

/**
 * 1 for each voxel, x fastest, whose centre a closed surface encloses. The surface is in index
 * coordinates; sides are found by counting crossings along rows of voxels.
 */
std::vector<char> EnclosedVoxels(const TriangleSurface& surface, const std::array<int, 3>& size);

/**
 * Voxels that are on the wrong side of a closed surface, as a share of the object's. The surface
 * is in index coordinates.
 */
double ShareOfWrongVoxels(const TriangleSurface& surface, const Scene& scene);

} // namespace volumic::support

#endif
