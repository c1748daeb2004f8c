// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationRun.h"

#include "Core/Common/Join.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Host/Errors.h"
#include "Input/InputPoints.h"
#include "Output/SurfaceOutput.h"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Return a copy, or null if memory does not suffice. */
std::unique_ptr<ConvergedSurface> TryCopy(const ConvergedSurface& surface)
{
  try
  {
    return std::make_unique<ConvergedSurface>(surface);
  }
  catch (const std::bad_alloc&)
  {
    return nullptr;
  }
}
}

SegmentationRun::SegmentationRun(const SegmentationRequest& request, const Volume& volume)
  : Request(request), Levels(request, volume)
{
  this->Settings.Check();
  SurfaceOptions& options = this->Settings.Options;
  options.RecoverMissedParts = this->Settings.Recovery != RecoveryType::NoRecovery;
  // Voxels above the range are enclosed by the object in most images.
  options.RecoverCavities = options.RecoverMissedParts &&
    (this->Settings.Recovery == RecoveryType::RecoverObjectsAndCavities ||
      this->Settings.Range().IsUsed());
  options.SeedRadius = std::min(options.SeedRadius, volume.Voxels.Levels[0].Image->GetLength()) /
    this->Levels.GetComputationalSpace().WorldUnit();
  if (this->Settings.EdgeLength != 0.0 && !volume.IsOfImage)
  {
    this->ChooseEdgeLength();
  }
  this->Request.Volume = nullptr; // The levels are released one by one.
}

void SegmentationRun::ChooseEdgeLength()
{
  std::vector<double> units;
  for (int level = 0; level < this->Levels.Pyramid().NumberOfLevels(); ++level)
  {
    units.push_back(this->Levels.Pyramid().UnitInWorld(level));
  }
  const EdgeLengthPlan plan = PlanEdgeLength(this->Settings.EdgeLength, units,
    EdgeLengthPreferences{ PyramidOptions(), this->Settings.Options.SamplingRatio });
  this->Settings.End.FinestLevel = plan.FinestLevel;
  this->Settings.Options.SamplingRatio = plan.SamplingRatio;
  this->Levels.SetFactorBelowLevel0(plan.ReductionFactor);
}

int SegmentationRun::EndOf(const SegmentationEnd& end) const
{
  const int finest =
    this->Settings.EdgeLength != 0.0 ? this->Settings.End.FinestLevel : end.FinestLevel;
  return end.Preview ? std::max(finest, this->Choice.Preview) : finest;
}

bool SegmentationRun::Renew(const SegmentationRequest& request)
{
  HostThreads threads(request.Settings.End.NumberOfThreads);
  const bool hasAll = this->HasAll(request);
  if (!hasAll && !this->CanResume())
  {
    return false;
  }
  const int finest = this->Settings.End.FinestLevel;
  SegmentationSettings settings = this->Settings;
  settings.End = request.Settings.End;
  settings.End.FinestLevel = settings.EdgeLength != 0.0 ? finest : settings.End.FinestLevel;
  this->Request = request;
  this->Request.Volume = nullptr;
  this->Settings = settings;
  if (hasAll)
  {
    this->Choice.Last = this->EndOf(settings.End);
  }
  else
  {
    const int before =
      std::exchange(this->Choice, ChooseLevels(this->Levels, settings, threads)).Coarsest;
    // The coarsest level may depend on the finest one. Restart if it changes.
    if (this->Choice.Coarsest != before)
    {
      if (!this->Levels.Pyramid().HasVoxels(this->Choice.Coarsest))
      {
        return false;
      }
      this->Begin();
    }
  }
  return this->ChooseComponents(request, threads);
}

bool SegmentationRun::ChooseComponents(const SegmentationRequest& request, Executor& threads)
{
  ComponentChoice choice =
    ChoiceOf(request, this->Levels.GetComputationalSpace(), this->Levels.Pyramid().SizeOf(0));
  choice.Seeds = this->Levels.Seeds();
  return this->Finished.Choose(choice, threads);
}

void SegmentationRun::Begin()
{
  this->Finished = FinishedLevels(this->Levels.Pyramid().NumberOfLevels(), this->Choice.Coarsest,
    this->Levels.GetComputationalSpace());
  this->Converged = ConvergedSurface();
  this->Reached = this->Choice.Coarsest + 1;
  this->CanContinue = true;
}

void SegmentationRun::Run(RunObserver& observer, double before)
{
  HostThreads threads(this->Settings.End.NumberOfThreads);
  if (!std::exchange(this->HasBegun, true))
  {
    this->Choice = ChooseLevels(this->Levels, this->Settings, threads);
    this->Begin();
    this->ChooseComponents(this->Request, threads);
    CheckOptions(this->Settings.Options);
  }
  this->Finished.SetStopped("");
  if (!this->HasReachedEnd())
  {
    LevelMonitor monitor(observer, before, this->Choice.Coarsest, this->EndsAt());
    this->Converged.History.StartClock(observer.Start());
    while (
      this->CanContinue && this->Reached > this->EndsAt() && this->Next(observer, monitor, threads))
    {
    }
  }
  this->Request.InitialSurface = this->Request.AttractingPoints = nullptr;
}

bool SegmentationRun::Next(RunObserver& observer, LevelMonitor& monitor, HostThreads& threads)
{
  const int level = this->Reached - 1;
  // Keep a copy in case this level is stopped.
  const std::unique_ptr<ConvergedSurface> before =
    this->Request.MayResume && level < this->Choice.Coarsest ? TryCopy(this->Converged) : nullptr;
  LevelOutcome outcome;
  if (monitor.BeginLevel(level))
  {
    this->Finished.Forget(level); // An earlier run may have been stopped there.
    this->Levels.ReleaseCoarserThan(level);
    const LevelImage image = this->Levels.Load(level, this->Settings.Options, threads);
    LevelTask task = this->TaskOf(level, image, threads);
    outcome = this->Evolve(task, monitor, threads);
  }
  const bool isStopped = outcome.Reason == StopReason::Cancelled;
  if (outcome.HasReachedLevel)
  {
    this->KeepLevel(level, std::move(outcome), observer, threads);
    if (level == this->EndsAt() && this->PreviewMissesParts(level))
    {
      this->Choice.Last = this->Choice.Preview = level - 1;
      monitor.ContinueAtLevel(level - 1);
    }
  }
  else
  {
    this->Finished.SetStopped(observer.StopReason());
  }
  this->Finished.SetRows(this->Converged.History.Rows);
  if (isStopped && before)
  {
    this->Converged = std::move(*before);
    this->Reached = level + 1;
    this->CanContinue = true;
  }
  return !isStopped;
}

LevelTask SegmentationRun::TaskOf(int level, const LevelImage& image, HostThreads& threads)
{
  const double unit = this->Levels.GetComputationalSpace().WorldUnit();
  LevelTask task;
  task.Options = this->Settings.Options;
  task.Image = image;
  task.Level = level;
  if (level == this->Settings.End.FinestLevel)
  {
    task.MeanEdgeLength = this->Settings.EdgeLength / unit;
    task.Grading = this->Settings.Grading;
    task.Grading.ThinParts = task.Grading.ThinParts && level < 0;
    task.Grading.Tolerance /= unit;
    task.Grading.MaximumEdgeLength /= unit;
  }
  task.Observe = [this, level, &threads](int iteration, const std::function<SurfaceResult()>& take)
  { this->TakeSnapshot(level, iteration, take, threads); };
  return task;
}

LevelOutcome SegmentationRun::Evolve(LevelTask& task, LevelMonitor& monitor, HostThreads& threads)
{
  if (task.Level < this->Choice.Coarsest)
  {
    return EvolveOnLevel(task, this->Converged, threads, monitor);
  }
  const bool isGiven = this->Settings.Initialization == InitializationType::InputSurface;
  return PrefixErrors(isGiven ? "Input port 1 (Initial Surface): " : "",
    [&]
    {
      SurfaceStart start =
        StartOf(this->Request, this->Levels.GetComputationalSpace(), this->Levels.Seeds());
      if (start.From == SurfaceStart::Kind::Enclosing && this->Choice.StartsAtParts)
      {
        start.From = SurfaceStart::Kind::EnclosingParts;
      }
      task.Start = &start;
      return EvolveOnLevel(task, this->Converged, threads, monitor);
    });
}

void SegmentationRun::TakeSnapshot(
  int level, int iteration, const std::function<SurfaceResult()>& take, HostThreads& threads)
{
  const int interval = this->Settings.SnapshotInterval;
  if (interval == 0)
  {
    return;
  }
  // There is a surface only at the end of a sweep of several iterations.
  const bool isDue =
    iteration == 0 || iteration / interval > this->LastSnapshotIteration / interval;
  this->LastSnapshotIteration = iteration;
  SurfaceResult surface = isDue ? take() : SurfaceResult();
  if (!surface.Points.empty())
  {
    SurfaceDescription description;
    description.Level = level;
    description.StartLevel = this->Choice.Coarsest;
    description.Unit = this->Levels.Pyramid().UnitInWorld(level);
    description.Iterations = iteration;
    description.TotalIterations = static_cast<int>(this->Converged.History.Rows.size());
    ComponentChoice choice;
    choice.Seeds = this->Levels.Seeds();
    this->Finished.AddSnapshot(level, Join("Level ", level, ", iteration ", iteration),
      MakePolyData(
        std::move(surface), description, this->Levels.GetComputationalSpace(), choice, threads));
  }
}

void SegmentationRun::KeepLevel(
  int level, LevelOutcome outcome, RunObserver& observer, HostThreads& threads)
{
  const StopReason reason = outcome.Reason;
  FinishedLevel finished;
  finished.IsConverged = reason != StopReason::Cancelled;
  finished.Description.Level = level;
  finished.Description.StartLevel = this->Choice.Coarsest;
  finished.Description.Unit = this->Levels.Pyramid().UnitInWorld(level);
  finished.Description.Iterations = outcome.Iterations;
  finished.Description.StopReason = finished.IsConverged ? Describe(reason) : observer.StopReason();
  if (level < this->Choice.Coarsest || this->Choice.StartsAtParts)
  {
    finished.Description.Missed = outcome.Missed;
  }
  if (outcome.Verified.Found > 0)
  {
    observer.Warn(outcome.Verified.Describe(level));
  }
  this->Finished.Add(
    std::move(finished), std::move(outcome.Surface), this->Request.KeepsAll, threads);
  this->Converged.History.EndLevel();
  this->Reached = level;
  // With recovery a finer level may recover a vanished surface.
  this->CanContinue = reason == StopReason::Converged || reason == StopReason::LimitCycle ||
    reason == StopReason::IterationLimit ||
    (reason == StopReason::Vanished && this->Settings.Options.RecoverMissedParts);
}

bool SegmentationRun::PreviewMissesParts(int level) const
{
  return this->Settings.End.Preview && this->CanContinue &&
    level > std::max(this->Settings.End.FinestLevel, 0) &&
    this->Settings.Recovery != RecoveryType::NoRecovery &&
    this->Finished.DescriptionOf(level).Missed.MissingBoundary > FinishedLevels::NotableFraction;
}

void SegmentationRun::ReleaseRunData()
{
  this->Levels.ReleaseCoarserThan(PyramidLevels::AllLevels);
  this->Converged = ConvergedSurface();
}
}
