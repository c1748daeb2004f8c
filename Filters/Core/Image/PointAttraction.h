// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPointAttraction_h
#define volumicPointAttraction_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Image/FieldOptions.h"
#include "Core/Image/LevelImage.h"

#include <vector>

namespace volumic
{
/** A point known to belong to the object. */
struct AttractingPoint
{
  Point Position = { 0., 0., 0. }; ///< in the computational space
  double Weight = 1.; ///< at least 0, multiplied by SurfaceOptions::PointAttractionWeight
  double Radius = 0.; ///< in the computational space; 0: LeastRadius units of the level
};

/**
 * Attraction by points known to belong to the object (future work without a formula in section 7 of
 * the paper). The points change the field instead of adding a force. Forces, merges, recovery and
 * the final snap then agree with each other, and a merge can close a gap of the image.
 *
 * With V the field on the object's side of the iso-value (Field::Sample::Value) and C a quarter of
 * the contrast of a typical boundary over a unit of the level:
 *
 *   V'(x) = V(x) + e(x) (2 max(-V(x), 0) + C),   e = 1 - exp(-k sum_i w W_i phi(|x - p_i| / r_i)),
 *   phi(s) = (1 - (s / 1.5)^2)^2 for s < 1.5, else 0.
 *
 * e lies in [0, 1[, so |V'| is bounded by |V| + C. k yields e = 1/2, the sign change in a dark
 * background, at distance r from a single point of weight 1. An isolated point in the background
 * therefore creates a ball of about its radius. Near a boundary, the boundary moves out to the
 * point. Points near each other join. Weights below about 0.3 only affect values close to the
 * iso-value.
 *
 * Radii are at least LeastRadius units of the level. Marked features, such as the middle of a thin
 * vessel, therefore exist at coarse levels, too, and shrink at finer ones.
 */
class PointAttraction
{
public:
  static constexpr double LeastRadius = 2.; ///< in units of the level

  /** @param weight w; no effect if it is 0 or there is no point */
  PointAttraction(std::vector<AttractingPoint> points, double weight);

  /**
   * Return the changed LevelImage::Values of a level, for the same Base. The sum over the points
   * has a fixed order, so the result does not depend on the executor. Cost: O(voxels + those near
   * points).
   */
  std::vector<float> Bend(
    const LevelImage& image, const FieldOptions& options, Executor& executor) const;

private:
  void AddPoint(const LevelImage& image, const AttractingPoint& point, int slice,
    std::vector<float>& evidence) const;
  static double ReachOf(const LevelImage& image, const AttractingPoint& point);

  std::vector<AttractingPoint> Points;
  double Weight;
};
}

#endif
