// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What the project has set itself, and what became of it in these runs. */

#ifndef volumicSurfaceTargets_h
#define volumicSurfaceTargets_h

#include "SurfaceTables.h"

namespace volumic
{
namespace bench
{

/** A row per target, with a heading: what it is, the figure, the limit, and `reached`, `missed` or
    `not run`. Speed is compared by processor seconds on one thread, S6 by seconds of the clock.
    Quality (Q) is that of us-1, the worst of all its levels; Q5 compares the bits of all runs with
    different numbers of threads and of all repetitions. */
TextRows TargetRows(const std::vector<SurfaceRunResult>& runs);

} // namespace bench
} // namespace volumic

#endif
