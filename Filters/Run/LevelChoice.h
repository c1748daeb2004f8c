// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelChoice_h
#define volumicLevelChoice_h

#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationSettings.h"

namespace volumic
{
/** Which levels a run visits. */
struct LevelChoice
{
  /** Preview ends at the finest level of at most so many voxels. */
  static constexpr int VoxelsOfPreview = 1000000;

  int Coarsest = 0;
  int Last = 0;    ///< the finest to visit
  int Preview = 0; ///< the finest to visit for a preview
};

/**
 * Those that the settings ask for. CoarsestLevel -1 becomes the coarsest level on which anything of
 * the object is left; without recovery, and where nothing but the isopotential moves the surface,
 * on which it is thick enough for a surface that starts there not to vanish.
 * @throws std::invalid_argument if there are no such levels, if the iso-value is not within the
 *         voxels, or if nothing of the object is left at the coarsest level.
 */
LevelChoice ChooseLevels(const SegmentationLevels& levels, const SegmentationSettings& settings);
}

#endif
