// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelConstraints_h
#define volumicLabelConstraints_h

#include "Core/Labels/LabelField.h"

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
/** A constraint changes the field no further than this many voxels along an axis. */
constexpr int ConstraintReach = 3;

/** What the field must be at a voxel: at least Margin, times Side. */
struct VoxelConstraint
{
  std::int64_t Place; ///< in the field
  float Side;         ///< 1 inside, -1 outside
  float Margin;
};

/**
 * Changes the field by the smallest sum of kernels about these voxels that meets the constraints:
 * step 4 of MakeLabelField(). Where they are too many and too different, they are met as far as a
 * bounded number of sweeps over them gets.
 */
void ConstrainToLabels(LabelField& field, const std::array<double, 3>& spacing,
  const std::vector<VoxelConstraint>& constraints);
}

#endif
