// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicWrongVoxels_h
#define volumicWrongVoxels_h

#include "SyntheticScenes.h"
#include "TriangleSurface.h"

namespace volumic
{
namespace support
{

/**
 * Voxels that are on the wrong side of a closed surface, as a share of the object's. The surface
 * is in index coordinates; sides are found by counting crossings along rows of voxels.
 */
double ShareOfWrongVoxels(const TriangleSurface& surface, const Scene& scene);

} // namespace support
} // namespace volumic

#endif
