// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelDistance_h
#define volumicLabelDistance_h

#include "Core/Common/Executor.h"
#include "Core/Labels/LabelField.h"
#include "Core/Labels/LabelSides.h"

#include <array>

namespace volumic
{
/**
 * Compute a smooth signed distance to the boundary of an object: steps 1 and 2 of MakeLabelField().
 * @param field has the box of `sides`; only the voxels of its Rows are written
 */
void MakeLabelDistance(const LabelSides& sides, const std::array<double, 3>& spacing,
  const LabelFieldOptions& options, LabelField& field, Executor& executor);
}

#endif
