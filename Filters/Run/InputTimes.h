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
/** What comes to a filter, and when it was changed last: the same as long as a run is valid. */
using InputTimes = std::vector<std::pair<vtkDataObject*, vtkMTimeType>>;
InputTimes InputTimesOf(vtkAlgorithm* filter);

/** Whether what a filter has made of its inputs may be kept: not where data are released. */
bool MayKeepRun(vtkAlgorithm* filter);
}

#endif
