// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGivenPositions_h
#define volumicGivenPositions_h

#include "Core/Common/IndexedSurface.h"
#include "Workspace.h"

#include <array>
#include <vector>

namespace volumic
{
/**
 * A list of positions of vtkDeformableSurface (world coordinates), in the workspace.
 * One that is out of the box of the image by less than a voxel, as one that was picked on its
 * border may be, is moved onto the box.
 * @param label of the property, for messages
 * @param size  voxels of level 0 along each axis
 * @throws std::invalid_argument for a position farther outside, or one that is not finite.
 */
std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label, const Workspace& space,
  const std::array<int, 3>& size);
}

#endif
