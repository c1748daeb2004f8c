// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SurfaceSegmentation.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Host/Errors.h"
#include "Input/InputPoints.h"
#include "Output/SurfaceOutput.h"
#include "Run/RunStart.h"

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Null where the memory does not suffice for it: a run can do without. */
std::unique_ptr<SurfaceAtRest> CopyIfRoom(const SurfaceAtRest& rest)
{
  try
  {
    return std::make_unique<SurfaceAtRest>(rest);
  }
  catch (const std::bad_alloc&)
  {
    return nullptr;
  }
  catch (const ScratchFull&)
  {
    return nullptr;
  }
}

}

SurfaceSegmentation::SurfaceSegmentation(const SegmentationRequest& request)
  : Request(request), Levels(request)
{
  this->Settings.Check();
  SurfaceOptions& options = this->Settings.Options;
  options.RecoverLostParts = this->Settings.Recovery != RecoveryType::NoRecovery;
  // What is above a range is more often within the object than not.
  options.RecoverCavities = options.RecoverLostParts &&
    (this->Settings.Recovery == RecoveryType::RecoverObjectsAndCavities ||
      this->Settings.Range().IsUsed());
  options.SeedRadius /= this->Levels.GetWorkspace().WorldUnit();
  this->ChooseEdgeLength();
  this->Levels.ReadAttraction(this->Request);
  this->Request.Levels = nullptr; // Each is let go when the surface has left it.
}

SurfaceSegmentation::~SurfaceSegmentation() = default;

void SurfaceSegmentation::ChooseEdgeLength()
{
  if (this->Settings.EdgeLength == 0.0 || this->Request.LevelsAreOwn)
  {
    return;
  }
  std::vector<double> units;
  for (int level = 0; level < this->Levels.Pyramid().NumberOfLevels(); ++level)
  {
    units.push_back(this->Levels.UnitInWorld(level));
  }
  EdgeLengthPreferences preferences;
  preferences.SamplingRatio = this->Settings.Options.SamplingRatio;
  const EdgeLengthPlan plan = PlanEdgeLength(this->Settings.EdgeLength, units, preferences);
  this->Settings.End.FinestLevel = plan.FinestLevel;
  this->Settings.Options.SamplingRatio = plan.SamplingRatio;
  this->Levels.SetFactorBelowLevel0(plan.ReductionFactor);
}

void SurfaceSegmentation::Run()
{
  const int before = this->Choice.Coarsest;
  this->Choice = ChooseLevels(this->Levels, this->Settings);
  if (!this->HasBegun)
  {
    this->Request.Warn(this->Levels.DescribeUnreportedNaNs()); // Once for all that go on from it.
  }
  // Where a run begins may depend on where it is to end; then nothing of the last one serves.
  if (!this->HasBegun || this->Choice.Coarsest != before)
  {
    this->Begin();
  }
  this->Found.SetStoppedSurface(nullptr);
  this->PrepareCheckpoint();
  if (!this->Found.HasAtRest(this->Choice.Last))
  {
    this->Threads.emplace(this->Settings.End.NumberOfThreads);
    this->Progress.emplace(
      this->Request.Progress, this->Choice.Coarsest, this->Choice.Last, this->Request.Limit);
    try
    {
      this->RunLevels();
    }
    catch (const ScratchFull&)
    {
      // Whose disk is full wants nothing to be left on it.
      if (this->Left)
      {
        this->Left->Remove();
      }
      throw;
    }
    this->Threads.reset();
  }
  const bool isOver = this->Found.HasAtRest(this->Choice.Last) && !this->Request.IsStep;
  if (this->Left && isOver && !this->Request.CheckpointStays)
  {
    this->Left->Remove();
  }
  if (!this->Request.IsStep)
  {
    this->Request.Warn(this->Found.WarningOf(this->Choice.Last, this->Settings.WantsAllParts()));
  }
  this->Request.InitialSurface = this->Request.AttractingPoints = nullptr;
}

void SurfaceSegmentation::Begin()
{
  this->HasBegun = false;
  this->Found = SegmentationResults(this->Settings.Profile, this->Levels.Pyramid().NumberOfLevels(),
    this->Choice.Coarsest, this->Levels.GetWorkspace(), this->Levels.Pyramid().SizeOfLevel0());
  this->Choose(this->Request);
  this->Found.SetPreviewLevel(this->Choice.Preview);
}

void SurfaceSegmentation::RunLevels()
{
  if (!std::exchange(this->HasBegun, true))
  {
    CheckOptions(this->Settings.Options);
    this->Rest = SurfaceAtRest();
    this->Reached = this->Choice.Coarsest + 1;
    this->GoesOn = true;
    this->Resume();
  }
  this->Rest.History.StartClock(this->Request.Started);
  bool isStopped = false;
  while (!isStopped && this->GoesOn && this->Reached > this->Choice.Last)
  {
    isStopped = !this->RunLevel(this->Reached - 1);
  }
}

bool SurfaceSegmentation::RunLevel(int level)
{
  // What rests stays while a finer level is under way, which may be stopped.
  const std::unique_ptr<SurfaceAtRest> before =
    this->Request.MayGoOn && level < this->Choice.Coarsest ? CopyIfRoom(this->Rest) : nullptr;
  LevelOutcome outcome;
  if (this->Progress->BeginLevel(level))
  {
    this->Found.Forget(level); // Of a run that was stopped there.
    this->Levels.ReleaseCoarserThan(level);
    const LevelImage image = this->Levels.Load(level, this->Settings.Options, *this->Threads);
    LevelTask task = this->TaskOf(level, image);
    outcome = this->Evolve(task);
  }
  const bool isStopped = outcome.Reason == StopReason::Cancelled;
  if (outcome.HasCome)
  {
    this->GoesOn = this->KeepLevel(level, std::move(outcome));
    this->Reached = level;
    if (level == this->Choice.Last && this->PreviewMissesParts(level))
    {
      this->Choice.Last = level - 1;
      this->Progress->GoOnTo(level - 1);
      this->Found.SetPreviewLevel(level - 1);
    }
    this->LeaveCheckpoint(level);
  }
  else
  {
    this->KeepStoppedSurface(level);
  }
  this->Found.SetRows(this->Rest.History.Rows);
  if (isStopped && before)
  {
    this->Rest = std::move(*before);
    this->Reached = level + 1;
    this->GoesOn = true;
  }
  return !isStopped;
}

LevelTask SurfaceSegmentation::TaskOf(int level, const LevelImage& image)
{
  const double unit = this->Levels.GetWorkspace().WorldUnit();
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
  task.Look = [this, level](int iteration, const std::function<SurfaceResult()>& take)
  { this->TakeSnapshot(level, iteration, take); };
  return task;
}

LevelOutcome SurfaceSegmentation::Evolve(LevelTask& task)
{
  if (task.Level < this->Choice.Coarsest)
  {
    return EvolveOnLevel(task, this->Rest, *this->Threads, *this->Progress);
  }
  const InitializationType type = this->Settings.Initialization;
  const std::vector<Point> seeds = type == InitializationType::Seeds
    ? PositionsOf(this->Settings.End.SeedPositions, "Seed Positions", this->Levels.GetWorkspace(),
        this->Levels.Pyramid().SizeOfLevel0())
    : std::vector<Point>();
  const bool ofPositions = !seeds.empty() && !this->Request.InitialSurface;
  const bool isGiven =
    type == InitializationType::InputSurface || type == InitializationType::Seeds;
  const char* place = ofPositions ? "Seed Positions: "
    : isGiven                     ? "Input port 1 (Initial Surface): "
                                  : "";
  return PrefixErrors(place,
    [&]
    {
      SurfaceStart start = StartOf(this->Request, this->Levels.GetWorkspace(), seeds);
      if (start.From == SurfaceStart::Kind::Enclosing && this->Choice.StartsAtParts)
      {
        start.From = SurfaceStart::Kind::EnclosingParts;
      }
      task.Start = &start;
      return EvolveOnLevel(task, this->Rest, *this->Threads, *this->Progress);
    });
}

void SurfaceSegmentation::TakeSnapshot(
  int level, int iteration, const std::function<SurfaceResult()>& take)
{
  const int interval = this->Settings.SnapshotInterval;
  if (interval == 0)
  {
    return;
  }
  // Iterations come in sweeps: the end of that in which one is due.
  const bool isDue = iteration == 0 || iteration / interval > this->SnapshotLook / interval;
  this->SnapshotLook = iteration;
  SurfaceResult surface = isDue ? take() : SurfaceResult();
  if (!surface.Points.empty())
  {
    SurfaceDescription description;
    description.Level = level;
    description.Unit = this->Levels.UnitInWorld(level);
    description.Iterations = iteration;
    description.TotalIterations = static_cast<int>(this->Rest.History.Rows.size());
    this->Found.AddSnapshot(level, Join("Level ", level, ", iteration ", iteration),
      MakePolyData(std::move(surface), description, this->Levels.GetWorkspace(), *this->Threads));
  }
}

bool SurfaceSegmentation::PreviewMissesParts(int level) const
{
  return this->Settings.End.Preview && this->GoesOn &&
    level > std::max(this->Settings.End.FinestLevel, 0) &&
    this->Settings.Recovery != RecoveryType::NoRecovery &&
    this->Found.Levels().at(level).Description.Lost.MissingBoundary >
    SegmentationResults::NotableShare;
}

bool SurfaceSegmentation::KeepLevel(int level, LevelOutcome outcome)
{
  const StopReason reason = outcome.Reason;
  SegmentationResults::Level result;
  result.IsAtRest = reason != StopReason::Cancelled;
  SurfaceDescription& description = result.Description;
  description.Level = level;
  description.Unit = this->Levels.UnitInWorld(level);
  description.Iterations = outcome.Iterations;
  description.StopReason = result.IsAtRest ? Describe(reason) : this->DescribeStop();
  if (level < this->Choice.Coarsest || this->Choice.StartsAtParts)
  {
    description.Lost = outcome.Lost;
  }
  if (outcome.Verified.Found > 0)
  {
    this->Request.Warn(outcome.Verified.Describe(level));
  }
  if (this->Request.KeepsAll)
  {
    result.All = std::make_shared<const SurfaceResult>(outcome.Surface);
  }
  this->Found.MakeSurface(result, std::move(outcome.Surface), *this->Threads);
  this->Found.SetLevel(level, result);
  this->Rest.History.EndLevel();
  // With recovery a finer level may find again what has vanished.
  return reason == StopReason::Converged || reason == StopReason::LimitCycle ||
    reason == StopReason::IterationLimit ||
    (reason == StopReason::Vanished && this->Settings.Options.RecoverLostParts);
}

std::string SurfaceSegmentation::DescribeStop() const
{
  return this->Progress->IsOutOfTime() ? TimeLimitReason : Describe(StopReason::Cancelled);
}

void SurfaceSegmentation::KeepStoppedSurface(int level)
{
  if (level == this->Choice.Coarsest)
  {
    this->Found.SetStoppedSurface(MakeStopped(level, this->DescribeStop()));
    return;
  }
  // The block of the level above is a surface at rest and stays one.
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(this->Found.SurfaceOf(level + 1));
  SetStopReason(surface, this->DescribeStop());
  this->Found.SetStoppedSurface(surface);
}
}
