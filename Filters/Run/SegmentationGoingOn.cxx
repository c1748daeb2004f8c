// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// From where a run that has ended goes on: what is there already, and checkpoints in files.

#include "Run/SurfaceSegmentation.h"

#include "Run/RunFingerprint.h"

#include <algorithm>
#include <memory>
#include <string>

namespace volumic
{
bool SurfaceSegmentation::Choose(const SegmentationRequest& request)
{
  HostThreads threads(request.Settings.End.NumberOfThreads);
  return this->Found.Choose(request, threads);
}

int SurfaceSegmentation::EndOf(const SegmentationRequest& request) const
{
  const SegmentationEnd& end = request.Settings.End;
  const int finest =
    this->Settings.EdgeLength != 0.0 ? this->Settings.End.FinestLevel : end.FinestLevel;
  return end.Preview ? std::max(finest, this->Found.LevelOfPreview()) : finest;
}

bool SurfaceSegmentation::HasAll(const SegmentationRequest& request)
{
  if (!this->Found.HasAtRest(this->EndOf(request)) || !this->Choose(request))
  {
    return false;
  }
  this->Found.SetStoppedSurface(nullptr); // That was on the way to a finer one.
  return true;
}

bool SurfaceSegmentation::Renew(const SegmentationRequest& request)
{
  SegmentationSettings settings = this->Settings;
  settings.End = request.Settings.End;
  if (settings.EdgeLength != 0.0)
  {
    settings.End.FinestLevel = this->Settings.End.FinestLevel;
  }
  this->Request = request;
  this->Settings = settings;
  // Levels up to the one at which it rests are there.
  const int coarsest = ChooseLevels(this->Levels, this->Settings).Coarsest;
  return this->Choose(request) &&
    (coarsest == this->Choice.Coarsest || this->Levels.HasVoxels(coarsest));
}

void SurfaceSegmentation::LetGo()
{
  this->Levels.ReleaseCoarserThan(PyramidLevels::AllLevels);
  this->Rest = SurfaceAtRest();
  this->Left.reset();
}

bool SurfaceSegmentation::CanGoOn() const
{
  const bool holdsImage = this->Reached <= 0 && this->Found.HasAtRest(this->Choice.Last);
  return this->GoesOn && !holdsImage;
}

void SurfaceSegmentation::PrepareCheckpoint()
{
  if (!this->Settings.End.LeavesCheckpoints())
  {
    this->Left.reset();
  }
  else if (this->HasBegun)
  {
    // It goes on with the one that it has: levels that it has let go of tell nothing any more.
    this->Request.Prepared(this->Left);
  }
  else
  {
    HostThreads threads(this->Settings.End.NumberOfThreads);
    SegmentationSettings settings = this->Settings;
    settings.CoarsestLevel = this->Choice.Coarsest;
    this->Left = std::make_shared<SegmentationCheckpoint>(settings.End.ScratchDirectory,
      RunFingerprint(settings, this->Request, this->Levels, threads));
  }
}

void SurfaceSegmentation::Resume()
{
  if (!this->Left)
  {
    return;
  }
  if (this->Settings.End.Resume)
  {
    if (const auto place = this->Left->Load(this->Found, this->Rest))
    {
      this->Reached = place->Level;
      this->GoesOn = place->GoesOn;
      this->Found.SetRows(this->Rest.History.Rows);
    }
  }
  this->Request.Prepared(this->Left);
}

void SurfaceSegmentation::LeaveCheckpoint(int level)
{
  const bool isLast = level <= this->Choice.Last && !this->Request.IsStep;
  if (!this->Left || !this->Found.HasAtRest(level) || (isLast && !this->Request.CheckpointStays))
  {
    return;
  }
  this->Request.Warn(this->Left->Save(this->Found, this->Rest, { level, this->GoesOn }));
}
}
