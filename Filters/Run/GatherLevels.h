// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGatherLevels_h
#define volumicGatherLevels_h

#include "Core/Common/Communicator.h"
#include "Settings/SegmentationVolume.h"

class vtkInformation;

namespace volumic
{
/**
 * By all ranks together: the levels that they hold in pieces, whole at rank 0; of those that are
 * large enough for all ranks to work on only where a map of edges is wanted. Each has the voxels
 * as its active scalars, the map, and what is blanked; the others keep their pieces. One rank keeps
 * what it has.
 * @param edges selection of the map, as GetInputArrayInformation()
 * @throws std::invalid_argument where the blocks are not the levels of a pyramid, or a level that
 *         stays in pieces has voxels that are infinite, or NaN where these are refused.
 */
void GatherLevels(Communicator& ranks, SegmentationVolume& volume, vtkInformation* edges);
}

#endif
