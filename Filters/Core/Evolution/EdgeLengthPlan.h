// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeLengthPlan_h
#define volumicEdgeLengthPlan_h

#include "Core/Image/PyramidGeometry.h"

#include <vector>

namespace volumic
{
/**
 * Mean length of the edges of a level that rests, in delta. Found by experiment, on nine scans in
 * both metrics: from 1.5 (smooth heads) to 1.8 (skulls). LevelTask::MeanEdgeLength makes
 * up for the difference.
 */
constexpr double MeanEdgeInDelta = 1.7;

/** What gives edges of a wanted mean length at the finest level, within eq. (7). */
struct EdgeLengthPlan
{
  int FinestLevel = 0;         ///< -1: finer than the image
  double ReductionFactor = 0.; ///< T of the pyramid; by level -1 also what it is finer by
  double SamplingRatio = 0.;   ///< delta_h / U_h, in [sqrt(3)/2.5, 1]
};

/** What a plan should come near to, and what it must keep to. */
struct EdgeLengthPreferences
{
  PyramidOptions Pyramid; ///< of the factor as much as the length allows; the rest to the letter
  double SamplingRatio = 0.85;
};

/**
 * For an image of which the pyramid is still to be made. delta is T^h SamplingRatio U_0; of all
 * levels h, factors T and ratios that give it, those with the least weighted sum of squares of the
 * logarithms of T and the ratio over what is preferred. T stays within what one sqrt 3 division can
 * follow.
 *
 * @param edgeLength mean length of the edges, in the unit of `spacing`, more than 0
 * @throws std::invalid_argument naming the lengths that are possible, if this one is not.
 */
EdgeLengthPlan PlanEdgeLength(double edgeLength, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences);

/**
 * For levels that are there: their units are given, so only the level and the ratio can be chosen
 * (and, finer than the image, how much finer).
 *
 * @param units U_h of each level, level 0 first, in the unit of edgeLength
 * @throws std::invalid_argument naming the lengths that are possible, if this one is not.
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, const std::vector<double>& units, const EdgeLengthPreferences& preferences);
}

#endif
