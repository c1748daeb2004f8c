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
/** Which levels a run visits. */
struct LevelChoice
{
  /** Preview ends at the finest level of at most so many voxels. */
  static constexpr int VoxelsOfPreview = 1000000;

  int Coarsest = 0;
  /** Whether to start about the parts that the coarsest shows, as coarser ones show none. */
  bool StartsAtParts = false;
  int Last = 0;    ///< the finest to visit
  int Preview = 0; ///< the finest to visit for a preview
};

/**
 * Those that the settings ask for. CoarsestLevel -1 becomes the coarsest level on which anything of
 * the object is left; and if that is not the last, or there is no recovery, on which a part of it
 * is large enough for a surface that starts there, where nothing but the isopotential moves it.
 * If there are seeds and CoarsestLevel is -1, the run starts at the coarsest level that has all of
 * them inside the object.
 * @throws std::invalid_argument if there are no such levels, if the iso-value is not within the
 *         voxels, or if nothing of the object is left at the coarsest level, or at its seeds.
 */
LevelChoice ChooseLevels(
  SegmentationLevels& levels, const SegmentationSettings& settings, Executor& threads);

/**
 * What the surface begins with on the coarsest level, as Initialization says: the polygons of
 * the initial surface, triangulated, or the seeds (workspace). With recovery, and where nothing but
 * the isopotential moves it, the surface begins with all of the object instead of seeds, and the
 * components at seeds are selected later.
 * @throws std::invalid_argument for an initial surface that cannot be read
 */
SurfaceStart StartOf(const SegmentationRequest& request, const ComputationalSpace& space,
  const std::vector<Point>& seeds);
}

#endif
