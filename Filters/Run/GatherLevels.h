// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGatherLevels_h
#define volumicGatherLevels_h

#include "Core/Common/Communicator.h"
#include "Settings/SegmentationVolume.h"

#include <string>

class vtkInformation;

namespace volumic
{
/**
 * By all ranks together: the levels that they hold in pieces, whole at rank 0; of those that are
 * large enough for all ranks to work on only where something asks for it. Each has the voxels
 * as its active scalars, the map of edges, and what is blanked; the others keep their pieces. One
 * rank keeps what it has.
 * @param edges selection of the map, as GetInputArrayInformation()
 * @return of the finest large one that is whole, why; empty: there is none
 * @throws std::invalid_argument where the blocks are not the levels of a pyramid.
 */
std::string GatherLevels(Communicator& ranks, SegmentationVolume& volume, vtkInformation* edges);
}

#endif
