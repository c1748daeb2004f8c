// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSmallParts_h
#define volumicSmallParts_h

#include "Core/Labels/LabelMap.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Reassign small parts to the remaining object, or the background, with which they share most
 * faces. A part is a 26-connected component of the voxels of an object.
 * @param objects      sorted objects whose parts are reassigned
 * @param leastVoxels  parts with fewer voxels are reassigned
 * @param keepsLargest whether to reassign all parts of an object except for its largest as well
 */
void ReassignSmallParts(
  LabelMap& map, const std::vector<int>& objects, std::int64_t leastVoxels, bool keepsLargest);

/**
 * Make each part of an object a separate object, so that the volume of each part is preserved. The
 * largest part keeps the number of the object. Other parts get new numbers in order of decreasing
 * size, until no numbers are left; remaining parts stay with the object. LabelMap::WholeOf is set.
 */
void SeparateParts(LabelMap& map);
}

#endif
