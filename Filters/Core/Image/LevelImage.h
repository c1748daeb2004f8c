// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelImage_h
#define volumicLevelImage_h

#include "Core/Image/VoxelValues.h"

#include <array>

namespace volumic
{
/**
 * Level of the image pyramid in the computational space.
 *
 * The axes of the computational space are those of the image, the first voxel is the origin, and
 * the unit is the smallest voxel distance of level 0. Section 5.2 of the paper has two variants:
 * index coordinates of level 0, in which voxels are cubes, or a metric that keeps the ratios s of
 * the voxel distances. All levels share origin and extent [0, s_x M_0) x [0, s_y N_0) x [0, s_z
 * P_0) (eq. 3). Voxel (i, j, k) lies at (i Step[0], j Step[1], k Step[2]) with Step = s M_0 / M_h
 * along each axis. All lengths in the core are lengths in the computational space.
 *
 * Values and Edges are not owned.
 */
struct LevelImage
{
  VoxelValues Values; ///< Size[0] * Size[1] * Size[2] values, x fastest
  /**
   * Image value minus Values. It keeps differences exact in single precision for images far from 0,
   * such as 10^9 to 10^9 + 50.
   */
  double Base = 0.;
  std::array<int, 3> Size = { 0, 0, 0 };       ///< number of voxels along each axis
  std::array<double, 3> Step = { 1., 1., 1. }; ///< distance between neighbours
  double Unit = 1.;                            ///< U_h = T^h (U_0 = 1)
  VoxelValues Edges;                           ///< optional edge map at the same voxels
};
}

#endif
