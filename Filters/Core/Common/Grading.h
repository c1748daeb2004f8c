// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGrading_h
#define volumicGrading_h

#include <algorithm>

namespace volumic
{
/**
 * How the edges of a surface may differ: as long as a tolerance allows where the isopotential is
 * flat, as short as the finest level's where that, or what is thin, asks for it.
 */
struct Grading
{
  /** How far a face may be from the isopotential; 0: all edges are of one length. */
  double Tolerance = 0.0;
  /** 0: AutomaticGrowth times what edges may be elsewhere; from that to MostGrowth times that. */
  double MaximumEdgeLength = 0.0;
  double Gradation = 0.2; ///< By how much delta grows per length walked.
  /** Edges are shorter than those of the level before only where the object, or the air, is thin.
   */
  bool ThinParts = false;

  static constexpr double MostGradation = 0.3;
  /** As far as the thickness is looked for, in the least delta: about four voxels. */
  static constexpr float MostThickness = 8.f;
  static constexpr float AutomaticGrowth = 4.f;
  static constexpr float MostGrowth = 5.f;

  bool IsRequested() const { return this->HasTolerance() || this->ThinParts; }
  bool HasTolerance() const { return this->Tolerance != 0.0; }
  /** How many times longer edges may become that may be up to `longest` elsewhere. */
  double Growth(double longest) const
  {
    return this->MaximumEdgeLength > 0.0
      ? std::clamp(this->MaximumEdgeLength / longest, 1.0, static_cast<double>(MostGrowth))
      : AutomaticGrowth;
  }
};

/** How far a surface is from the isopotential. */
struct Fit
{
  double LargestDistance = 0.0; ///< No further is looked than GradedSizes::Furthest().
  double WithinTolerance = 1.0; ///< Share of the points that are looked at.
};
}

#endif
