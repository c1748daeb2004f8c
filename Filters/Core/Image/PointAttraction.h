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
  Point Place = { 0., 0., 0. }; ///< Workspace.
  double Weight = 1.;           ///< At least 0, times SurfaceOptions::PointAttractionWeight.
  double Radius = 0.;           ///< Workspace; 0: LeastRadius units of the level.
};

/**
 * Attraction by points known to belong to the object (the paper's section 7 names it as future
 * work and gives no formula). The points bend the field instead of adding a force beside it: all
 * that the surface asks of the image, forces, consent to merges, recovery of lost parts, the
 * final snap, then agrees with them, so a merge may close a gap that the image leaves open.
 *
 * With V the field on the object's side of the iso-value (Field::Sample::Value) and C a quarter of
 * the contrast of a typical boundary over a unit of the level:
 *
 *   V'(x) = V(x) + e(x) (2 max(-V(x), 0) + C),   e = 1 - exp(-k sum_i w W_i phi(|x - p_i| / r_i)),
 *   phi(s) = (1 - (s / 1.5)^2)^2 for s < 1.5, else 0.
 *
 * e lies in [0, 1[, so V' is bounded by |V| + C; k makes e = 1/2, the turning point of a dark
 * background, at the distance r of one point of weight 1. So a point alone in the background gets
 * a ball of the object whose radius is about the point's, however dark the background is; near a
 * boundary the boundary comes out to the point; points near each other join. A point of less
 * weight than about 0.3 only tips places that are near the iso-value anyway.
 *
 * Radii are at least LeastRadius units of the level, so that what the points mark, such as the
 * middle of a thin vessel, is there at the coarse levels too, and shrinks on the way down.
 */
class PointAttraction
{
public:
  static constexpr double LeastRadius = 2.; ///< Units of the level.

  /** `weight` is w; 0, or no point, switches it off. */
  PointAttraction(std::vector<AttractingPoint> points, double weight);

  /**
   * LevelImage::Values of a level with the field bent, for the same Base. Sums over the points are
   * in their order, slice by slice: the same for any executor. Cost: O(voxels + those near points).
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
