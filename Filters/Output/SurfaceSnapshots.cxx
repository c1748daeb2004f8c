// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/SurfaceSnapshots.h"

#include "Core/Common/Refuse.h"
#include "Output/SurfaceOutput.h"

#include <vtkPolyData.h>

#include <utility>

namespace volumic
{
SurfaceSnapshots::SurfaceSnapshots(int interval, const Workspace& space)
  : Interval(interval), Space(space)
{
}

void SurfaceSnapshots::TakeIfDue(
  const SurfaceEvolution& evolution, int level, double unit, int iteration,
  SegmentationResults& results, Executor& threads)
{
  if (this->Interval == 0)
  {
    return;
  }
  // Iterations come in sweeps: the end of that in which one is due.
  const bool isDue = iteration == 0 || iteration / this->Interval > this->Last / this->Interval;
  this->Last = iteration;
  if (!isDue)
  {
    return;
  }
  SurfaceResult surface = evolution.Result();
  if (surface.Points.empty())
  {
    return;
  }
  SurfaceDescription description;
  description.Level = level;
  description.Unit = unit;
  description.Iterations = iteration;
  description.TotalIterations = static_cast<int>(evolution.History().size());
  results.AddSnapshot(level, Join("Level ", level, ", iteration ", iteration),
    MakePolyData(std::move(surface), description, this->Space, threads));
}
}
