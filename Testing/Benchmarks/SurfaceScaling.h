// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What threads gain, by the clock, and what memory a volume takes. */

#ifndef volumicSurfaceScaling_h
#define volumicSurfaceScaling_h

#include "SurfaceBenchmarkOptions.h"

namespace volumic
{
namespace bench
{

/** us-N for each N of options.Threads in turn, as many rounds as options.Repetitions, on the volume
    at options.Sizes, each run in a process of its own: median seconds, and the median of the first
    one's seconds over the other's in the same round. Prints tables and targets, writes the CSV
    files. Returns whether all went well. */
bool MeasureThreads(const SurfaceBenchmarkOptions& options);

/** us-1 on the volume at options.Sizes, each first written to a file by another process, so that
    nothing but the image and the run is in the memory that is measured. The same otherwise. */
bool MeasurePeaks(const SurfaceBenchmarkOptions& options);

} // namespace bench
} // namespace volumic

#endif
