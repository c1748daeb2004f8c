// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelMapPadding_h
#define volumicLabelMapPadding_h

#include "Core/Image/VoxelBox.h"
#include "Core/Labels/LabelMap.h"

namespace volumic
{
/** Has what is beyond a box go on with the nearest voxel in it, or with what its other end has. */
void PadLabelMap(LabelMap& map, const VoxelBox& box, bool isPeriodic);

/**
 * In a periodic map the last slice of the box and the first one, which follows it, differ as
 * neighbouring ones do.
 * @throws std::invalid_argument where they do not along an axis
 */
void CheckPeriodic(const LabelMap& map, const VoxelBox& box);
}

#endif
