// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelImage_h
#define volumicLevelImage_h

#include <array>

namespace volumic
{
/**
 * One level of the image pyramid as the surface sees it, in the workspace.
 *
 * The workspace is the space in which the voxels of level 0 are cubes of side 1: the index
 * coordinates of level 0, with the first voxel at the origin (the paper's section 5.2). All levels
 * share origin and extent [0, M_0) x [0, N_0) x [0, P_0) (eq. 3), so voxel (i, j, k) lies at
 * (i Step[0], j Step[1], k Step[2]) with Step = M_0 / M_h along each axis. All lengths inside the
 * core are lengths of the workspace.
 *
 * Values and Edges are not owned and must outlive every call they are given to.
 */
struct LevelImage
{
  const float* Values = nullptr;               ///< x fastest, Size[0] * Size[1] * Size[2] of them.
  std::array<int, 3> Size = { 0, 0, 0 };       ///< Number of voxels along each axis.
  std::array<double, 3> Step = { 1., 1., 1. }; ///< Distance of neighbouring voxels, workspace.
  double Unit = 1.;                            ///< U_h = T^h, workspace (U_0 = 1).
  const float* Edges = nullptr; ///< May be null: a map of edges at the same voxels.
};
}

#endif
