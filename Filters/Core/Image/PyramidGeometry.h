// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidGeometry_h
#define volumicPyramidGeometry_h

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Number of voxels along each axis. */
using LevelSize = std::array<std::int64_t, 3>;

/**
 * Where the voxels of one level lie (eq. 3): voxel i along an axis is at i * Spacing from the
 * origin, which all levels share. Spacing is mu / M_h in the unit of length of the input; it has
 * the sign of the input's.
 */
struct LevelGeometry
{
  LevelSize Size = { 0, 0, 0 };                ///< M_h, N_h, P_h
  std::array<double, 3> Spacing = { 1, 1, 1 }; ///< mu/M_h, nu/N_h, pi/P_h
  double Unit = 1.0;                           ///< U_h

  /** Number of voxels, 64 bits wide also where a product of three ints would overflow. */
  std::int64_t NumberOfVoxels() const { return Size[0] * Size[1] * Size[2]; }
};

/** Which levels to make of an image. */
struct PyramidOptions
{
  double ReductionFactor = 1.7320508075688772; ///< T, in ]1, 2[; sqrt(3) suits the surface (eq. 8)
  int NumberOfLevels = 0;                      ///< with level 0; 0 = as MinimumLevelSize allows
  int MinimumLevelSize = 10; ///< automatic: no level after 0 has an axis of fewer voxels than this
};

/**
 * Sizes, spacings and units of all levels, level 0 (the input) first: eq. 4 with U_h = T^h U_0.
 *
 * An axis of one voxel stays one voxel at every level and counts neither for U_0, because no two
 * voxels have a distance along it, nor for MinimumLevelSize; so 2D images work like volumes.
 *
 * @throws std::invalid_argument for T outside ]1, 2[, a negative option, sizes under 1, a spacing
 *         that is zero or not finite along an axis of several voxels, and when more levels are
 *         asked for than the image can give (the message says how many it can).
 */
std::vector<LevelGeometry> PlanPyramid(
  const LevelSize& size, const std::array<double, 3>& spacing, const PyramidOptions& options);

/**
 * How many levels the image can give: the last is the first in which no axis can shrink further.
 */
int MaximumNumberOfLevels(const LevelSize& size, double reductionFactor);

/** Size of the level above one of this size: floor(M / T), at least 1. */
LevelSize ReducedSize(const LevelSize& size, double reductionFactor);
}

#endif
