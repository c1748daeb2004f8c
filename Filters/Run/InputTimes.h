// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInputTimes_h
#define volumicInputTimes_h

#include <vtkType.h>

#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace volumic
{
/** The inputs of a filter with their modification times. Any change invalidates the kept run. */
using InputTimes = std::vector<std::pair<vtkDataObject*, vtkMTimeType>>;
InputTimes InputTimesOf(vtkAlgorithm* filter);

/** Return whether the filter may keep its run. It may not if input or output data are released. */
bool MayKeepRun(vtkAlgorithm* filter);
}

#endif
