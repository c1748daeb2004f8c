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

/** Preferred factor and ratio; the other options of the pyramid are kept. */
struct EdgeLengthPreferences
{
  PyramidOptions Pyramid;
  double SamplingRatio = 0.85;
};

/**
 * Plan for an image whose pyramid does not exist yet. delta is SamplingRatio T^h U_0. The level h is
 * the nearest one at the preferred T and ratio. T is what gives delta at this level and ratio, within
 * what one sqrt 3 division can follow. Beyond that, and on level 0, the ratio differs.
 *
 * @param edgeLength mean length of the edges, in the unit of `spacing`, more than 0
 * @throws std::invalid_argument naming the possible lengths if this one is not among them.
 */
EdgeLengthPlan PlanEdgeLength(double edgeLength, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences);

/**
 * Plan for existing levels: only the level and the ratio can be chosen, and the factor of level -1.
 *
 * @param units U_h of each level, level 0 first, in the unit of edgeLength
 * @throws std::invalid_argument naming the possible lengths if this one is not among them.
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, const std::vector<double>& units, const EdgeLengthPreferences& preferences);
}

#endif
