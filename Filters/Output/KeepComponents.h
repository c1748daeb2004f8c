// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicKeepComponents_h
#define volumicKeepComponents_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Input/ComputationalSpace.h"
#include "Settings/SegmentationSettings.h"

#include <array>
#include <vector>

namespace volumic
{
/** Selection of components for the outputs. */
struct ComponentChoice
{
  bool IsInverted = false; ///< select all others; no effect on AllComponents
  KeepComponentsType Mode = KeepComponentsType::AllComponents;
  double MinimumVolume = 0.0;   ///< world units cubed
  std::vector<Point> Positions; ///< computational space
  /** Seeds in computational space. If there are any, only components at seeds are selected. */
  std::vector<Point> Seeds;

  bool operator==(const ComponentChoice& other) const
  {
    return this->Mode == other.Mode && this->MinimumVolume == other.MinimumVolume &&
      this->Positions == other.Positions && this->Seeds == other.Seeds;
  }
};

/** The selected components of a surface with their features. */
struct DescribedSurface
{
  SurfaceResult Shape; ///< points in world coordinates, normals and lengths in computational space
  SurfaceFeatures Features; ///< world units
  /** Owner of each component: itself, or for a cavity the component around it (-1: none). */
  std::vector<int> Owners;
};

/**
 * Return the selection of a request, without seeds. The mode is AllComponents if points are
 * necessary and there are none.
 * @param size voxels of level 0 along each axis
 * @throws InvalidArgument if the settings are out of range
 */
ComponentChoice ChoiceOf(const SegmentationRequest& request, const ComputationalSpace& space,
  const std::array<int, 3>& size);

/**
 * Select the components of a closed surface, and compute their features. A cavity is kept with its
 * owner. A component encloses a position if it is the innermost component around it and not a
 * cavity. A component is at a position if it encloses it, or if a vertex of it or of its cavities
 * is within 2.5 delta. A component is at a seed if it encloses it, or, if none does, if a vertex is
 * within 2.5 delta. Complexity: O(n log n) in the number of triangles and positions.
 */
DescribedSurface DescribeSurface(SurfaceResult surface, const ComputationalSpace& space,
  const ComponentChoice& choice, Executor& executor);
}

#endif
