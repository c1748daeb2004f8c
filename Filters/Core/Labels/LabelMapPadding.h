// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelMapPadding_h
#define volumicLabelMapPadding_h

#include "Core/Image/VoxelBox.h"
#include "Core/Labels/LabelMap.h"

namespace volumic
{
/** Set the voxels beyond a box to the nearest voxel in it, or to the periodic continuation. */
void PadLabelMap(LabelMap& map, const VoxelBox& box, bool isPeriodic);

/**
 * Check that a map is periodic: the first slice differs from the last one as neighbouring slices
 * do.
 * @throws std::invalid_argument if the difference is too large along an axis
 */
void CheckPeriodic(const LabelMap& map, const VoxelBox& box);
}

#endif
