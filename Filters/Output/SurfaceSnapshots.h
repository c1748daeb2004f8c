// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSnapshots_h
#define volumicSurfaceSnapshots_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/Workspace.h"
#include "Output/SegmentationResults.h"

namespace volumic
{
/**
 * Takes snapshots of the surface as it evolves: at the start of each level and at the end of each
 * sweep of iterations in which one is due.
 */
class SurfaceSnapshots
{
public:
  /**
   * @param interval iterations from one to the next, each at the end of the sweep in which it is
   *                 due; 0: none is kept
   * @param space    must outlive the object
   */
  SurfaceSnapshots(int interval, const Workspace& space);

  /**
   * Adds one to the results if its turn has come and there is a surface, named `Level 3, iteration
   * 20`.
   * @param unit      U_h, world units
   * @param iteration of this level, 0 at its start
   */
  void TakeIfDue(const SurfaceEvolution& evolution, int level, double unit, int iteration,
    SegmentationResults& results, Executor& threads);

private:
  int Interval;
  int Last = 0; ///< Iteration that was looked at, of the level.
  const Workspace& Space;
};
}

#endif
