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

/** Return 1 for each voxel enclosed by a closed surface in index coordinates, x fastest. */
std::vector<char> EnclosedVoxels(const TriangleSurface& surface, const std::array<int, 3>& size);

/** Return the ratio of misclassified voxels to object voxels; surface in index coordinates. */
double MisclassifiedFraction(const TriangleSurface& surface, const Scene& scene);

} // namespace volumic::support

#endif
