// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelVoxels_h
#define volumicLevelVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ValidVoxels.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

class vtkDataArray;

namespace volumic
{
/** The share of the whole work that is done, in [0, 1], and the text for it; false asks to stop. */
using PyramidProgress = std::function<bool(double share, const std::string& text)>;

/**
 * The voxels of the levels above level 0, as far as they were finished before `progress` said stop.
 * Where not all voxels of level 0 are valid, those of the other levels are NaN whose
 * neighbourhood has more voxels without a value than with one.
 * @param voxels of level 0, contiguous in memory (ContiguousVoxels)
 * @throws std::invalid_argument if their type is not supported; std::runtime_error if the memory
 *         does not suffice.
 */
std::vector<vtkSmartPointer<vtkDataArray>> MakeLevelVoxels(vtkDataArray* voxels,
  const ValidVoxels& valid, const std::vector<LevelGeometry>& levels, Executor& executor,
  const PyramidProgress& progress);
}

#endif
