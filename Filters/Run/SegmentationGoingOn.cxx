// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Requests for another end, served from a run that has ended.

#include "Run/SurfaceSegmentation.h"

#include <algorithm>

namespace volumic
{
bool SurfaceSegmentation::Choose(const SegmentationRequest& request)
{
  HostThreads threads(request.Settings.End.NumberOfThreads);
  bool hasChosen = false;
  threads.Run([&] { hasChosen = this->Found.Choose(request, threads); });
  return hasChosen;
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
}

bool SurfaceSegmentation::CanGoOn() const
{
  const bool holdsImage = this->Reached <= 0 && this->Found.HasAtRest(this->Choice.Last);
  return this->GoesOn && !holdsImage;
}
}
