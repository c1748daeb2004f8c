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
/** Voxels that are all integers in the range of int, of any type. */
struct LabelValues
{
  vtkSmartPointer<vtkDataArray> Voxels;
  std::map<int, std::string> Numbers; ///< original values of renumbered labels
  std::string Conversions;            ///< warning about conversions; empty: none
};

/**
 * Convert voxels to labels. Floating-point numbers within 0.01 of integers are rounded, as after
 * resampling. NaN becomes background. Labels outside the range of int are renumbered from the
 * largest other label on.
 * @param voxels contiguous in memory, one component; shared if no conversion is necessary
 * @param most   maximum number of labels to renumber
 * @throws InvalidArgument for other numbers, or if too many labels are outside the range of int
 */
LabelValues LabelValuesOf(
  vtkDataArray* voxels, int background, std::size_t most, Executor& threads);
}

#endif
