// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeAttraction_h
#define volumicEdgeAttraction_h

#include "Core/Common/Executor.h"
#include "Core/Image/Field.h"
#include "Core/Image/LevelImage.h"

namespace volumic
{
/**
 * Attraction by edges detected beforehand (the paper's section 7 names it as future work and gives
 * no formula): LevelImage::Edges, which is large on edges, is minus a potential whose valleys are
 * the edges. A vertex descends it along its normal.
 *
 * The scale of the map does not matter: slopes count in parts of the typical slope of the map at
 * the level, the mean over the voxels of |gradient| weighted by itself, sum g^2 / sum g, which the
 * flat places between the edges leave alone.
 */
class EdgeAttraction
{
public:
  /** @param image with Edges, which must outlive the object. */
  EdgeAttraction(const LevelImage& image, Executor& executor);

  /**
   * The force along an outward unit normal for the weight 1: gradient of the map . n, in half of
   * the typical slope, clamped to [-1, 1]. Outside the image the map is that of the nearest voxel.
   */
  float Along(const Vector& position, const Vector& normal) const;

private:
  Field Map;
  float Scale = 0; ///< 0 where the map is flat.
};
}

#endif
