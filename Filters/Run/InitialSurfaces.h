// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInitialSurfaces_h
#define volumicInitialSurfaces_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/Workspace.h"
#include "Settings/SegmentationSettings.h"

#include <vector>

namespace volumic
{
/**
 * What the surface begins with on the coarsest level, as Initialization says: of the polygons of
 * the initial surface, triangulated, its points and those of `seeds` (workspace), or the
 * iso-surface of the level, closed at the border of the image by background.
 * @throws std::invalid_argument for an initial surface that cannot be read
 */
SurfaceStart StartOf(const SegmentationRequest& request, const Workspace& space,
  const std::vector<Point>& seeds, const LevelImage& image);
}

#endif
