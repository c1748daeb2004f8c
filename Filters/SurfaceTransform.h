// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceTransform_h
#define volumicSurfaceTransform_h

#include "Core/Common/IndexedSurface.h"
#include "Workspace.h"

namespace volumic
{
/** Makes outward what was inward. */
void FlipOrientation(IndexedSurface& surface);

/** The surface in world coordinates, outward oriented there, too. */
IndexedSurface ToWorld(const IndexedSurface& surface, const Workspace& space);

/** The surface in the workspace, outward oriented there, too. */
IndexedSurface ToWorkspace(const IndexedSurface& surface, const Workspace& space);
}

#endif
