// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGrading_h
#define volumicGrading_h

#include <algorithm>

namespace volumic
{
/**
 * Options of graded edge lengths. Edges are as long as the tolerance allows where the isosurface is
 * flat, and as short as those of the finest level where curvature or thin parts require it.
 */
struct Grading
{
  /** Largest distance of a face from the isosurface; 0: uniform edge length. */
  double Tolerance = 0.0;
  /** Longest edge; 0: AutomaticGrowth times the uniform length. At most MostGrowth times. */
  double MaximumEdgeLength = 0.0;
  double Gradation = 0.2; ///< increase of delta per distance
  /** Subdivide only where the object or the gap between walls is thin. */
  bool ThinParts = false;

  static constexpr double MostGradation = 0.3;
  /** Largest thickness that is measured, in the smallest delta: about four voxels. */
  static constexpr float MostThickness = 8.f;
  static constexpr float AutomaticGrowth = 4.f;
  static constexpr float MostGrowth = 5.f;

  bool IsRequested() const { return this->HasTolerance() || this->ThinParts; }
  bool HasTolerance() const { return this->Tolerance != 0.0; }
  /** Return the ratio of the longest edge to `longest`, the longest edge of a uniform surface. */
  double Growth(double longest) const
  {
    return this->MaximumEdgeLength > 0.0
      ? std::clamp(this->MaximumEdgeLength / longest, 1.0, static_cast<double>(MostGrowth))
      : AutomaticGrowth;
  }
};

/** Distance between a surface and the isosurface. */
struct Fit
{
  double LargestDistance = 0.0; ///< clamped to GradedSizes::Furthest()
  double WithinTolerance = 1.0; ///< fraction of the sampled points
};
}

#endif
