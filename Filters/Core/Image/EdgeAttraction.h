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
 * Attraction by detected edges (future work without a formula in section 7 of the paper). The
 * negated edge map LevelImage::Edges is a potential with valleys at the edges. A vertex descends it
 * along its normal.
 *
 * The force does not depend on the scale of the map. Slopes are relative to the typical slope of
 * the map at the level, sum g^2 / sum g over the voxels with g = |gradient|, to which flat regions
 * do not contribute.
 */
class EdgeAttraction
{
public:
  /** @param image with Edges, which must outlive the object */
  EdgeAttraction(const LevelImage& image, Executor& executor);

  /**
   * Return the force along an outward unit normal for weight 1: the gradient of the map along the
   * normal, divided by half of the typical slope, clamped to [-1, 1]. Outside the image the nearest
   * voxel counts.
   */
  float Along(const Vector& position, const Vector& normal) const;

private:
  Field Map;
  float Scale = 0; ///< 0: the map is constant
};
}

#endif
