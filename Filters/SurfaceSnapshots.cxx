// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSnapshots.h"

#include "Core/Refuse.h"
#include "SurfaceOutput.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>

namespace volumic
{
SurfaceSnapshots::SurfaceSnapshots(int interval, const Workspace& space)
  : Interval(interval), Space(space), Taken(vtkSmartPointer<vtkMultiBlockDataSet>::New())
{
}

SurfaceSnapshots::~SurfaceSnapshots() = default;

void SurfaceSnapshots::Offer(
  const SurfaceEvolution& evolution, int level, double unit, int iteration)
{
  if (this->Interval == 0 || iteration % this->Interval != 0)
  {
    return;
  }
  const SurfaceResult surface = evolution.Result();
  if (surface.Points.empty())
  {
    return;
  }
  SurfaceDescription description;
  description.Level = level;
  description.Unit = unit;
  description.Iterations = iteration;
  description.TotalIterations = static_cast<int>(evolution.History().size());
  const unsigned int block = this->Taken->GetNumberOfBlocks();
  this->Taken->SetBlock(block, MakePolyData(surface, description, this->Space));
  this->Taken->GetMetaData(block)->Set(
    vtkCompositeDataSet::NAME(), Join("Level ", level, ", iteration ", iteration).c_str());
}
}
