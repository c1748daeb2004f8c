// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicKeepComponents_h
#define volumicKeepComponents_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Input/Workspace.h"
#include "Settings/SegmentationSettings.h"

#include <array>
#include <vector>

namespace volumic
{
/** Which components of a surface go into an output. */
struct ComponentChoice
{
  KeepComponentsType Mode = KeepComponentsType::AllComponents;
  double MinimumVolume = 0.0; ///< world units, cubed
  std::vector<Point> Places;  ///< workspace

  bool operator==(const ComponentChoice& other) const
  {
    return this->Mode == other.Mode && this->MinimumVolume == other.MinimumVolume &&
      this->Places == other.Places;
  }
};

/** A surface as the outputs hold it. */
struct DescribedSurface
{
  SurfaceResult Shape; ///< points and triangles in world coordinates, the rest in the workspace's
  SurfaceFeatures Features; ///< world units
  /**
   * The component that each one belongs to: itself or, for a cavity (negative volume), the solid one
   * that encloses it most closely; -1: none does.
   */
  std::vector<int> Owners;
};

/**
 * As the settings have it, and the inputs, in the workspace of an image.
 * @param size voxels of level 0 along each axis
 * @throws std::invalid_argument if the settings are out of range, or points to choose by are
 * missing
 */
ComponentChoice ChoiceOf(
  const SegmentationRequest& request, const Workspace& space, const std::array<int, 3>& size);

/**
 * The part of a closed surface that is chosen, in the world, and its features. A cavity is kept with
 * its owner. A component touches a place if it is the innermost that encloses it, and no cavity, or
 * if a vertex of it or of its cavities is not farther than 2.5 delta. The arrays of a surface that
 * is given up are used. Cost: O(n log n) of triangles and places.
 */
DescribedSurface DescribeSurface(SurfaceResult surface, const Workspace& space,
  const ComponentChoice& choice, Executor& executor);
}

#endif
