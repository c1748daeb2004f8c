// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicKeepComponents_h
#define volumicKeepComponents_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "SegmentationSettings.h"
#include "Workspace.h"

#include <vector>

class vtkPolyData;

namespace volumic
{
/// Which components of a surface go into an output.
struct ComponentChoice
{
  KeepComponentsType Mode = KeepComponentsType::AllComponents;
  double MinimumVolume = 0.0; ///< world units, cubed
  std::vector<Point> Places;  ///< workspace
};

/// The places for a choice by points: those that port 1 and port 2 mean (PointsMeantBy). Both may be
/// missing; a surface at port 1 has no seeds. Workspace.
/// @throws std::invalid_argument for other cells without vertices.
std::vector<Point> PlacesOf(vtkPolyData* port1, vtkPolyData* port2, const Workspace& space);

/**
 * The part of a closed surface that is chosen. A cavity (negative volume) belongs to the component
 * that encloses it most closely, and is kept with it. A component touches a place if it is the
 * innermost that encloses it, and no cavity, or if a vertex of it or of its cavities is not farther
 * than 2.5 delta. Cost: O(n log n) of triangles and places.
 */
SurfaceResult KeepChosen(
  const SurfaceResult& surface, const ComponentChoice& choice, const Workspace& space);
}

#endif
