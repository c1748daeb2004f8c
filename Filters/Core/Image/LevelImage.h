// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelImage_h
#define volumicLevelImage_h

#include "Core/Image/VoxelValues.h"

#include <array>

namespace volumic
{
/**
 * One level of the image pyramid as the surface sees it, in the workspace.
 *
 * The workspace is the space that the surface lives in: its axes are those of the image, the first
 * voxel is the origin, and 1 is the smallest distance of two voxels of level 0. Section 5.2 of the
 * paper offers two: the index coordinates of level 0, in which voxels are cubes, or a metric, in
 * which the distances along the axes keep their ratio s. All levels share origin and extent
 * [0, s_x M_0) x [0, s_y N_0) x [0, s_z P_0) (eq. 3), so voxel (i, j, k) lies at
 * (i Step[0], j Step[1], k Step[2]) with Step = s M_0 / M_h along each axis. All lengths inside the
 * core are lengths of the workspace.
 *
 * Values and Edges are not owned and must outlive every call they are given to.
 */
struct LevelImage
{
  VoxelValues Values; ///< x fastest, Size[0] * Size[1] * Size[2] of them.
  /**
   * What the values of the image are more than Values, so that those keep their differences in
   * single precision where the image lies far from 0 (10^9 to 10^9 + 50).
   */
  double Base = 0.;
  std::array<int, 3> Size = { 0, 0, 0 };       ///< Number of voxels along each axis.
  std::array<double, 3> Step = { 1., 1., 1. }; ///< Distance of neighbouring voxels, workspace.
  double Unit = 1.;                            ///< U_h = T^h, workspace (U_0 = 1).
  VoxelValues Edges; ///< There may be none: a map of edges at the same voxels.
};
}

#endif
