// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SurfaceSegmentation.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Host/PrefixErrors.h"
#include "Input/InputPoints.h"
#include "Output/SurfaceOutput.h"
#include "Run/InitialSurfaces.h"
#include "Settings/CheckEnumeration.h"
#include "Settings/CheckGrading.h"

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace volumic
{
SurfaceSegmentation::SurfaceSegmentation(
  const SegmentationVolume& volume, const SegmentationRequest& request)
  : Settings(volume.Settings), Levels(volume),
    Snapshots(volume.Settings.SnapshotInterval, this->Levels.GetWorkspace())
{
  SurfaceOptions& options = this->Settings.Options;
  CheckEnumeration(
    "Initialization", this->Settings.Initialization, InitializationType::InputSurface);
  CheckEnumeration("Border Value", options.BorderValue, Border::Replicate);
  CheckEnumeration(
    "Recovery", this->Settings.Recovery, RecoveryType::RecoverObjectsAndCavities);
  if (options.MaximumNumberOfIterations < 1)
  {
    Refuse("Maximum Number Of Iterations is ", options.MaximumNumberOfIterations,
      "; it must be at least 1.");
  }
  if (this->Settings.SnapshotInterval < 0)
  {
    Refuse(
      "Snapshot Interval is ", this->Settings.SnapshotInterval, "; it must be 0 (off) or more.");
  }
  if (options.SeedRadius < 0.0 || !std::isfinite(options.SeedRadius))
  {
    Refuse("Seed Radius is ", options.SeedRadius, "; it must be 0 (automatic) or more.");
  }
  this->CheckGrading();
  options.RecoverLostParts = this->Settings.Recovery != RecoveryType::NoRecovery;
  // What is above a range is more often within the object than not.
  options.RecoverCavities = options.RecoverLostParts &&
    (this->Settings.Recovery == RecoveryType::RecoverObjectsAndCavities ||
      this->Settings.Range().IsUsed());
  options.SeedRadius /= this->Levels.GetWorkspace().WorldUnit();
  this->Renew(request);
  this->ChooseEdgeLength(volume);
  this->Levels.ReadAttraction(volume.Levels, this->Settings, this->Request);
}

SurfaceSegmentation::~SurfaceSegmentation() = default;

void SurfaceSegmentation::CheckGrading() const
{
  const Grading& grading = this->Settings.Grading;
  const SurfaceOptions& options = this->Settings.Options;
  volumic::CheckGrading(grading, this->Settings.EdgeLength);
  if (grading.IsWanted() &&
    (!(options.IsopotentialWeight > options.EdgeAttractionWeight) || !options.SnapToIsoValue))
  {
    Refuse(WhatGrades(grading), ", but ",
      options.SnapToIsoValue
        ? "Isopotential Weight is not more than Edge Attraction Weight"
        : "Snap To Iso Value is off",
      ": the surface does not lie at the iso-value, from which ",
      grading.HasTolerance() ? "a tolerance is measured. Set it to 0" : "thickness is. Switch it off",
      ", or change that.");
  }
}

void SurfaceSegmentation::ChooseEdgeLength(const SegmentationVolume& volume)
{
  double factor = volume.FactorBelowLevel0;
  if (this->Settings.EdgeLength != 0.0 && !volume.EdgeLengthIsPlanned)
  {
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
    factor = plan.ReductionFactor;
  }
  this->Levels.SetFactorBelowLevel0(factor);
}

void SurfaceSegmentation::Start(SurfaceEvolution& evolution, const LevelImage& image)
{
  const Workspace& space = this->Levels.GetWorkspace();
  const int level = this->Choice.Coarsest;
  vtkPolyData* given = this->Request.InitialSurface;
  const InitializationType type = this->Settings.Initialization;
  std::vector<Point> seeds;
  if (type == InitializationType::Seeds)
  {
    seeds = this->Levels.SeedPositions(this->Settings);
  }
  const bool isGiven =
    type == InitializationType::InputSurface || type == InitializationType::Seeds;
  const bool ofPositions = !seeds.empty() && !given;
  const char* place =
    ofPositions ? "Seed Positions: " : isGiven ? "Input port 1 (Initial Surface): " : "";
  PrefixErrors(place,
    [&]
    {
      switch (type)
      {
        case InitializationType::Seeds:
        {
          const std::vector<Point> connected = SeedsOf(given, space);
          seeds.insert(seeds.begin(), connected.begin(), connected.end());
          evolution.StartSeeds(image, level, seeds);
          break;
        }
        case InitializationType::IsoSurface:
          evolution.StartIsoSurface(
            image, level, ClosedIsoSurface(image, this->Settings.Options));
          break;
        case InitializationType::InputSurface:
          evolution.StartSurface(image, level, SurfaceOf(given, space));
          break;
        case InitializationType::EnclosingIcosahedron:
          if (this->Choice.StartsAtParts)
          {
            evolution.StartEnclosingParts(image, level);
          }
          else
          {
            evolution.StartEnclosing(image, level);
          }
          break;
      }
    });
}

void SurfaceSegmentation::Renew(const SegmentationRequest& request)
{
  const int planned = this->Settings.End.FinestLevel;
  this->Request = request;
  this->Settings.End = request.End;
  if (this->Settings.EdgeLength != 0.0)
  {
    this->Settings.End.FinestLevel = planned;
  }
  this->HasChosen = !this->Evolution || Choose(this->Found, this->Settings, request);
}

void SurfaceSegmentation::Run()
{
  const int before = this->Choice.Coarsest;
  this->Choice = ChooseLevels(this->Levels, this->Settings);
  if (!this->Evolution)
  {
    // Once for all runs that go on from this one.
    const std::string text = this->Levels.DescribeUnreportedNaNs();
    if (!text.empty())
    {
      this->Request.Warn(text);
    }
  }
  // Where a run begins may depend on where it is to end; then nothing of the last one serves.
  if (!this->Evolution || this->Choice.Coarsest != before)
  {
    this->Begin();
  }
  this->Found.SetStoppedSurface(nullptr);
  this->PrepareCheckpoint();
  if (!this->Found.HasAtRest(this->Choice.Last))
  {
    // What the evolution refers to stays in its place.
    this->Threads.emplace(this->Settings.End.NumberOfThreads);
    this->Progress.emplace(
      this->Request.Progress, this->Choice.Coarsest, this->Choice.Last, this->Request.Limit);
    this->Progress->AfterSweep = [this](const Monitor::Status& status)
    {
      this->Snapshots.TakeIfDue(*this->Evolution, status.Level,
        this->Levels.UnitInWorld(status.Level), status.Iteration, this->Found,
        *this->Threads);
    };
    try
    {
      this->Threads->Run([this] { this->RunLevels(); });
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
  }
  const bool isOver = this->Found.HasAtRest(this->Choice.Last) && !this->Request.IsStep;
  if (this->Left && isOver && !this->Request.Checkpoints.Stay)
  {
    this->Left->Remove();
  }
  if (!this->Request.IsStep)
  {
    this->Found.WarnOf(this->Choice.Last, this->Settings.WantsAllParts(), this->Request.Warn);
  }
}

bool SurfaceSegmentation::Choose(SegmentationResults& results,
  const SegmentationSettings& settings, const SegmentationRequest& request)
{
  HostThreads threads(request.End.NumberOfThreads);
  bool hasChosen = false;
  threads.Run([&] { hasChosen = results.Choose(settings, request, threads); });
  return hasChosen;
}

bool SurfaceSegmentation::CanServe() const
{
  // Those up to the level at which it rests are there.
  const int coarsest = ChooseLevels(this->Levels, this->Settings).Coarsest;
  return this->HasChosen &&
    (coarsest == this->Choice.Coarsest || this->Levels.HasVoxels(coarsest));
}

bool SurfaceSegmentation::CanGoOn() const
{
  const bool holdsImage = this->Reached <= 0 && this->Found.HasAtRest(this->Choice.Last);
  return this->GoesOn && !holdsImage && !this->Evolution->IsStopped();
}

void SurfaceSegmentation::Begin()
{
  this->Evolution.reset();
  this->GoesOn = false;
  this->Found = SegmentationResults(this->Levels.Pyramid().NumberOfLevels(), this->Choice.Coarsest,
    this->Levels.GetWorkspace(), this->Levels.Pyramid().SizeOfLevel0(), this->Settings.Profile);
  Choose(this->Found, this->Settings, this->Request);
  this->Found.SetPreviewLevel(this->Choice.Preview);
}

void SurfaceSegmentation::RunLevels()
{
  if (!this->Evolution)
  {
    this->MakeEvolution();
    this->Reached = this->Choice.Coarsest + 1;
    this->GoesOn = true;
    this->Resume();
  }
  this->Evolution->StartClock(this->Request.Started);
  while (this->GoesOn && this->Reached > this->Choice.Last)
  {
    const int level = this->Reached - 1;
    if (!this->Progress->BeginLevel(level))
    {
      this->KeepStoppedSurface(level);
      break;
    }
    this->Found.Forget(level); // Of a run that was stopped there.
    this->Levels.ReleaseCoarserThan(level);
    const LevelImage image = this->Levels.Load(level, this->Settings.Options, *this->Threads);
    if (level == this->Settings.End.FinestLevel)
    {
      this->Evolution->SetMeanEdgeLength(this->WantedMeanEdge(level));
      Grading grading = this->Settings.Grading;
      grading.ThinParts = grading.ThinParts && level < 0;
      grading.Tolerance /= this->Levels.GetWorkspace().WorldUnit();
      grading.MaximumEdgeLength /= this->Levels.GetWorkspace().WorldUnit();
      this->Evolution->SetGrading(grading);
    }
    StopReason reason = StopReason::Cancelled;
    SurfaceResult surface;
    if (!this->EvolveOn(image, level, reason, surface))
    {
      this->KeepStoppedSurface(level);
      break;
    }
    this->GoesOn = this->KeepLevel(level, reason, std::move(surface));
    this->Reached = level;
    if (level == this->Choice.Last && this->PreviewMissesParts(level))
    {
      this->Choice.Last = level - 1;
      this->Progress->GoOnTo(level - 1);
      this->Found.SetPreviewLevel(level - 1);
    }
    this->LeaveCheckpoint(level);
  }
  this->Found.SetRows(this->Evolution->History());
  this->ReturnToRest();
}

void SurfaceSegmentation::MakeEvolution()
{
  this->Evolution =
    std::make_unique<SurfaceEvolution>(this->Settings.Options, *this->Threads, *this->Progress);
}

bool SurfaceSegmentation::PreviewMissesParts(int level) const
{
  return this->Settings.End.Preview && this->GoesOn &&
    level > std::max(this->Settings.End.FinestLevel, 0) &&
    this->Settings.Recovery != RecoveryType::NoRecovery &&
    this->Found.Levels().at(level).Description.MissingBoundary >
      SegmentationResults::NotableShare;
}

double SurfaceSegmentation::WantedMeanEdge(int level) const
{
  return level == this->Settings.End.FinestLevel
    ? this->Settings.EdgeLength / this->Levels.GetWorkspace().WorldUnit()
    : 0.0;
}

bool SurfaceSegmentation::EvolveOn(
  const LevelImage& image, int level, StopReason& reason, SurfaceResult& surface)
{
  SurfaceEvolution& evolution = *this->Evolution;
  const bool keepsRest = this->Request.MayGoOn && level < this->Choice.Coarsest;
  if (keepsRest)
  {
    this->Rest.Keep(evolution);
  }
  if (level == this->Choice.Coarsest)
  {
    this->Start(evolution, image);
  }
  else if (!evolution.Divide(image, level))
  {
    return false;
  }
  GiveBackFreeMemory();
  this->Snapshots.TakeIfDue(
    evolution, level, this->Levels.UnitInWorld(level), 0, this->Found, *this->Threads);
  reason = evolution.Run();
  const bool mayBeRevised = this->Request.Revise && level == this->Choice.Last && level <= 0 &&
    reason != StopReason::Cancelled;
  if (!mayBeRevised)
  {
    evolution.ForgetMotion();
  }
  GiveBackFreeMemory();
  surface = evolution.Result();
  while (mayBeRevised && !evolution.IsStopped() && !surface.Points.empty() &&
    this->Request.Revise(surface))
  {
    evolution.Revise(image);
    surface = evolution.Result();
  }
  reason = evolution.IsStopped() ? StopReason::Cancelled : reason;
  evolution.LeaveLevel();
  return true;
}

bool SurfaceSegmentation::KeepLevel(int level, StopReason reason, SurfaceResult surface)
{
  SegmentationResults::Level result;
  result.IsAtRest = reason != StopReason::Cancelled;
  SurfaceDescription& description = result.Description;
  description.Level = level;
  description.Unit = this->Levels.UnitInWorld(level);
  description.Iterations = this->Evolution->Iterations();
  description.StopReason = result.IsAtRest ? Describe(reason) : this->DescribeStop();
  const SurfaceEvolution::Verdict verdict = this->Evolution->Verified();
  if (verdict.Found > 0)
  {
    this->Request.Warn(verdict.Describe(level));
  }
  if (level < this->Choice.Coarsest || this->Choice.StartsAtParts)
  {
    const SurfaceEvolution::LostParts lost = this->Evolution->Lost();
    description.LostParts = lost.Found;
    description.RecoveredParts = lost.Enclosed;
    description.MissingParts = lost.Missing;
    description.MissingBoundary = lost.MissingBoundary;
    description.LostCavities = lost.FoundCavities;
    description.RecoveredCavities = lost.EnclosedCavities;
  }
  if (this->Request.KeepsAll)
  {
    result.All = std::make_shared<const SurfaceResult>(surface);
  }
  this->Found.MakeSurface(result, std::move(surface), *this->Threads);
  this->Found.SetLevel(level, result);
  this->Evolution->EndLevel();
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
