// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInitialSurfaces_h
#define volumicInitialSurfaces_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/LevelImage.h"
#include "Input/Workspace.h"

class vtkPolyData;

namespace volumic
{
/**
 * The polygons of a poly data, triangulated, as a surface of the workspace.
 * @throws std::invalid_argument if there is none.
 */
IndexedSurface SurfaceOf(vtkPolyData* polyData, const Workspace& space);

/**
 * The iso-surface of a level (workspace), closed at the border of the image by background, outward
 * oriented, by vtkFlyingEdges3D.
 */
IndexedSurface ClosedIsoSurface(const LevelImage& image, const SurfaceOptions& options);
}

#endif
