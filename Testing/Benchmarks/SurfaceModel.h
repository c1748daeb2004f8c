// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How long a run would take on more processors than there are: its tables. */

#ifndef volumicSurfaceModel_h
#define volumicSurfaceModel_h

#include "RunFigures.h"
#include "SurfaceBenchmarkOptions.h"
#include "WorkModel.h"

#include <vector>

namespace volumic
{
namespace bench
{

/** The phases as figures `model.i.NAME`, and back. */
void SetModel(const WorkModel& model, RunFigures& figures);
std::vector<WorkModel::Phase> ModelOf(const RunFigures& figures);

/** us-1 with a WorkModel in the place of its threads, on the volume at options.Sizes, each in a
    process of its own: seconds of 1 to 64 threads by phase, and what became of the targets. Prints
    the tables and writes the CSV files. Returns whether all went well. */
bool MeasureModel(const SurfaceBenchmarkOptions& options);

} // namespace bench
} // namespace volumic

#endif
