// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunStart_h
#define volumicRunStart_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/ComputationalSpace.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationSettings.h"

#include <vector>

namespace volumic
{
/** The levels of a run. */
struct LevelChoice
{
  /** Maximum number of voxels of the level at which a preview ends. */
  static constexpr int MaximumPreviewVoxels = 1000000;

  int Coarsest = 0;
  /** Whether to start with surfaces around the parts of the object at the coarsest level. */
  bool StartsAtParts = false;
  int Last = 0;    ///< finest level
  int Preview = 0; ///< finest level of a preview
};

/**
 * Choose the levels of a run. For CoarsestLevel -1 it starts at
 * - the coarsest level that has all seeds inside the object, if there are seeds
 * - else the coarsest level with any voxel of the object. If this is not the last level, or without
 *   recovery, a part of the object must be large enough for a surface. This condition does not
 *   apply if other forces than the isopotential move the surface.
 * @throws InvalidArgument if the levels do not exist, if the iso-value is outside the range of the
 *   voxels, or if the object is missing at the coarsest level or at its seeds
 */
LevelChoice ChooseLevels(
  SegmentationLevels& levels, const SegmentationSettings& settings, Executor& threads);

/**
 * Return the start at the coarsest level for Initialization: the triangulated initial surface, or
 * the seeds in computational space. With recovery, and if only the isopotential moves the surface,
 * a run with seeds starts around the whole object, and selects the components at seeds later.
 * @throws InvalidArgument for an initial surface without polygons or with invalid cells
 */
SurfaceStart StartOf(const SegmentationRequest& request, const ComputationalSpace& space,
  const std::vector<Point>& seeds);
}

#endif
