// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What the project has set itself, and what became of it in these runs. */

#ifndef volumicSurfaceTargets_h
#define volumicSurfaceTargets_h

#include "SurfaceTables.h"

#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

enum class Bound
{
  AtMost,
  AtLeast
};

/** Voxels from which a volume is one of 512^3, for which targets are others; sizes are rounded. */
constexpr double LargeVolume = 0.95 * 512 * 512 * 512;

/** A row of such a table: what it is, the figure, the limit, and `reached`, `missed` or, where the
    figure is NaN, `not run`. */
std::vector<std::string> TargetHeading();
std::vector<std::string> TargetRow(
  const std::string& name, const std::string& what, double figure, Bound bound, double limit);

/** A row per target of the runs side by side, with the heading. Speed is compared by processor seconds on one thread, S6 by seconds of the clock.
    Quality (Q) is that of us-1, the worst of all its levels; Q5 compares the bits of all runs with
    different numbers of threads and of all repetitions. */
TextRows TargetRows(const std::vector<SurfaceRunResult>& runs);

} // namespace bench
} // namespace volumic

#endif
