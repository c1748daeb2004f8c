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
/** Maximum distance along each axis at which a constraint changes the field, in voxels. */
constexpr int ConstraintReach = 3;

/** Constraint on the field value at a voxel: Side * value >= Margin. */
struct VoxelConstraint
{
  std::int64_t Index; ///< index of the voxel in LabelField::Values
  float Side;         ///< 1 inside, -1 outside
  float Margin;
};

/**
 * Add the smallest sum of kernels at these voxels to the field that satisfies the constraints: step
 * 4 of MakeLabelField(). The number of iterations is bounded, so that contradictory constraints are
 * satisfied only approximately.
 */
void ConstrainToLabels(LabelField& field, const std::array<double, 3>& spacing,
  const std::vector<VoxelConstraint>& constraints);
}

#endif
