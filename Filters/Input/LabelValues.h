// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelValues_h
#define volumicLabelValues_h

#include "Core/Common/Executor.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <cstddef>
#include <map>
#include <string>

namespace volumic
{
/** Voxels of which each is an int, in any type. */
struct LabelValues
{
  vtkSmartPointer<vtkDataArray> Voxels;
  std::map<int, std::string> Numbers; ///< what labels were that no int holds
  std::string Conversions;            ///< what was done; empty: nothing
};

/**
 * Real numbers that are whole but for a hundredth, as resampling leaves them, are rounded, and NaN
 * is the background; labels that no int holds get the numbers behind the largest of the others.
 * @param voxels contiguous in memory, of one component: shared where they are labels already
 * @param most   labels that may be numbered anew
 * @throws std::invalid_argument if a value is no whole number, or too many are no int.
 */
LabelValues LabelValuesOf(
  vtkDataArray* voxels, int background, std::size_t most, Executor& threads);
}

#endif
