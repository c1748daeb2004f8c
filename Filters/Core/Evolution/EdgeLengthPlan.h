// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeLengthPlan_h
#define volumicEdgeLengthPlan_h

#include "Core/Image/PyramidGeometry.h"

#include <vector>

namespace volumic
{
/**
 * Mean edge length of a converged level, in delta. By experiment on nine scans in both metrics: 1.5
 * (smooth heads) to 1.8 (skulls). LevelTask::MeanEdgeLength corrects the difference.
 */
constexpr double MeanEdgeInDelta = 1.7;

/** Options for a requested mean edge length at the finest level, within eq. (7). */
struct EdgeLengthPlan
{
  int FinestLevel = 0;         ///< -1: finer than the image
  double ReductionFactor = 0.; ///< T of the pyramid, and of level -1
  double SamplingRatio = 0.;   ///< delta_h / U_h, in [sqrt(3)/2.5, 1]
};

/** Preferred factor and ratio, and the other options of the pyramid. */
struct EdgeLengthPreferences
{
  PyramidOptions Pyramid;
  double SamplingRatio = 0.85;
};

/**
 * Plan the edge length for an image without a pyramid. delta is SamplingRatio T^h U_0. Level h is
 * the nearest one at the preferred T and ratio. T is adjusted to this level, within the range that
 * one sqrt 3 division can follow. Beyond this range, and at level 0, the ratio is adjusted.
 *
 * @param edgeLength mean edge length in the unit of `spacing`, more than 0
 * @throws std::invalid_argument naming the possible lengths if this one is not among them.
 */
EdgeLengthPlan PlanEdgeLength(double edgeLength, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences);

/**
 * Plan the edge length for existing levels: adjust the level, the ratio, and the factor of level
 * -1.
 *
 * @param units U_h of each level, level 0 first, in the unit of edgeLength
 * @throws std::invalid_argument naming the possible lengths if this one is not among them.
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, const std::vector<double>& units, const EdgeLengthPreferences& preferences);
}

#endif
