// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicKeepComponents_h
#define volumicKeepComponents_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "SegmentationSettings.h"
#include "Workspace.h"

#include <vector>

namespace volumic
{
/** Which components of a surface go into an output. */
struct ComponentChoice
{
  KeepComponentsType Mode = KeepComponentsType::AllComponents;
  double MinimumVolume = 0.0; ///< world units, cubed
  std::vector<Point> Places;  ///< workspace
};

/**
 * The part of a closed surface that is chosen. A cavity (negative volume) belongs to the component
 * that encloses it most closely, and is kept with it. A component touches a place if it is the
 * innermost that encloses it, and no cavity, or if a vertex of it or of its cavities is not farther
 * than 2.5 delta. Cost: O(n log n) of triangles and places; where all are kept and the surface is
 * given up, none.
 */
SurfaceResult KeepChosen(SurfaceResult surface, const ComponentChoice& choice,
  const Workspace& space, Executor& executor = OnThisThread());
}

#endif
