// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceTransform_h
#define volumicSurfaceTransform_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Input/Workspace.h"

namespace volumic
{
/** Makes outward what was inward. */
void FlipOrientation(IndexedSurface& surface, Executor& executor = OnThisThread());

/** The surface in world coordinates, outward oriented there; in its place if it is given up. */
IndexedSurface ToWorld(
  IndexedSurface surface, const Workspace& space, Executor& executor = OnThisThread());

/** The surface in the workspace, outward oriented there; in its place if it is given up. */
IndexedSurface ToWorkspace(
  IndexedSurface surface, const Workspace& space, Executor& executor = OnThisThread());
}

#endif
