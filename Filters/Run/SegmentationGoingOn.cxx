// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// From where a run that has ended early goes on: checkpoints in files, and in memory the last level
// at which the surface rested.

#include "Run/SurfaceSegmentation.h"

#include <memory>
#include <string>

namespace volumic
{
void SurfaceSegmentation::PrepareCheckpoint()
{
  const CheckpointRequest& wanted = this->Request.Checkpoints;
  if (!wanted.AreLeft && !wanted.Resumes)
  {
    this->Left.reset();
  }
  else if (this->Evolution)
  {
    // It goes on with the one that it has: levels that it has let go of tell nothing any more.
    this->Request.Checkpoints.Prepared(this->Left);
  }
  else
  {
    HostThreads threads(this->Settings.End.NumberOfThreads);
    threads.Run(
      [&]
      {
        SegmentationSettings settings = this->Settings;
        settings.CoarsestLevel = this->Choice.Coarsest;
        this->Left = std::make_shared<SegmentationCheckpoint>(
          wanted.Directory, RunFingerprint(settings, this->Request, this->Levels, threads));
      });
  }
}

void SurfaceSegmentation::Resume()
{
  if (!this->Left)
  {
    return;
  }
  if (this->Request.Checkpoints.Resumes)
  {
    const auto place = this->Left->Load(this->Found, *this->Evolution);
    if (place)
    {
      this->Reached = place->Level;
      this->GoesOn = place->GoesOn;
    }
  }
  this->Request.Checkpoints.Prepared(this->Left);
}

void SurfaceSegmentation::LeaveCheckpoint(int level)
{
  const CheckpointRequest& wanted = this->Request.Checkpoints;
  const bool isLast = level <= this->Choice.Last && !this->Request.IsStep;
  if (!this->Left || !wanted.AreLeft || !this->Found.HasAtRest(level) || (isLast && !wanted.Stay))
  {
    return;
  }
  const std::string warning =
    this->Left->Save(this->Found, *this->Evolution, { level, this->GoesOn });
  if (!warning.empty())
  {
    this->Request.Warn(warning);
  }
}

void SurfaceSegmentation::ReturnToRest()
{
  if (this->Evolution->IsStopped() && this->Rest.IsKept())
  {
    this->Evolution.reset(); // Not both at a time.
    this->MakeEvolution();
    this->GoesOn = this->Rest.GiveTo(*this->Evolution);
    if (this->GoesOn)
    {
      this->Reached += this->Found.HasAtRest(this->Reached) ? 0 : 1;
    }
    else
    {
      this->Evolution.reset(); // The surface as it was stopped stays.
    }
  }
  this->Rest.Drop();
}
}
