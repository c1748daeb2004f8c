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
 * Geometry of a level (eq. 3): voxel i along an axis lies at i * Spacing from the origin, which all
 * levels share. Spacing is mu / M_h in the length unit of the input, with the sign of its spacing.
 */
struct LevelGeometry
{
  LevelSize Size = { 0, 0, 0 };                ///< M_h, N_h, P_h
  std::array<double, 3> Spacing = { 1, 1, 1 }; ///< mu/M_h, nu/N_h, pi/P_h
  double Unit = 1.0;                           ///< U_h

  std::int64_t NumberOfVoxels() const { return Size[0] * Size[1] * Size[2]; }
};

/** Properties of vtkImagePyramid. */
struct PyramidOptions
{
  double ReductionFactor = 1.7320508075688772; ///< T, in ]1, 2[; sqrt(3) suits the surface (eq. 8)
  int NumberOfLevels = 0;                      ///< including level 0; 0: automatic
  int MinimumLevelSize = 10;                   ///< automatic: smallest dimension of levels above 0
};

/**
 * Return sizes, spacings and units of all levels, from level 0 (the input) on: eq. 4 with
 * U_h = T^h U_0. An axis of one voxel keeps one voxel. It has no effect on U_0 nor
 * MinimumLevelSize, so 2D images work like volumes.
 *
 * @throws std::invalid_argument if T is outside ]1, 2[, an option is negative, a size is below 1, a
 *         spacing along an axis of several voxels is zero or not finite, or NumberOfLevels exceeds
 *         MaximumNumberOfLevels()
 */
std::vector<LevelGeometry> PlanPyramid(
  const LevelSize& size, const std::array<double, 3>& spacing, const PyramidOptions& options);

/** Return the number of levels until no axis can shrink further. */
int MaximumNumberOfLevels(const LevelSize& size, double reductionFactor);

/** Return the size of the next coarser level: floor(M / T), at least 1. */
LevelSize ReducedSize(const LevelSize& size, double reductionFactor);
}

#endif
