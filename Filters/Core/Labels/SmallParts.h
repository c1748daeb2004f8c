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
 * Give parts of objects, voxels joined by faces, edges or corners, to the object, or the outside,
 * that they share most faces with, of those that are left.
 * @param objects      whose parts these are, sorted; other objects keep theirs
 * @param leastVoxels  parts of fewer voxels are given away
 * @param keepsLargest all parts of an object but its largest, too
 */
void GiveAwaySmallParts(
  LabelMap& map, const std::vector<int>& objects, std::int64_t leastVoxels, bool keepsLargest);

/**
 * Make each part of an object, joined as above, an object of its own, so that each keeps its
 * volume: the largest part keeps the number, others get numbers above all objects, larger parts
 * first, while there are numbers left; what is left stays with the object. LabelMap::WholeOf tells.
 */
void SeparateParts(LabelMap& map);
}

#endif
