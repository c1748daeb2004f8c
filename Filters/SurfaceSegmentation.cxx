// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSegmentation.h"

#include "Core/Common/Refuse.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "InitialSurfaces.h"
#include "InputPoints.h"
#include "PrefixErrors.h"
#include "SurfaceOutput.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>

namespace volumic
{
namespace
{
template <typename Enumeration>
void CheckEnumeration(const char* name, Enumeration value, Enumeration last)
{
  const int number = static_cast<int>(value);
  if (number < 0 || value > last)
  {
    Refuse(name, " is ", number, "; it must be 0 to ", static_cast<int>(last), ".");
  }
}

/// Image Pyramid has counted them, and tells it itself where it is a filter of the user's.
bool MayHaveNaNsToTell(const SegmentationVolume& volume)
{
  vtkDataArray* counted = volume.Levels->GetFieldData()->GetArray("NaNVoxels");
  return !counted || (volume.LevelsAreOwn && counted->GetTuple1(0) > 0.0);
}

/** The levels, with errors that name the port. */
PyramidLevels ReadLevels(const SegmentationVolume& volume)
{
  const SegmentationSettings& settings = volume.Settings;
  CheckEnumeration("Metric", settings.Metric, Metric::World);
  return PrefixErrors("Input port 0: ",
    [&] {
      return PyramidLevels(
        volume.Levels, volume.Selection, settings.Metric, settings.NaNIsBackground);
    });
}
}

SurfaceSegmentation::SurfaceSegmentation(
  const SegmentationVolume& volume, const SegmentationRequest& request)
  : Settings(volume.Settings), MayHaveUntoldNaNs(MayHaveNaNsToTell(volume)),
    Pyramid(ReadLevels(volume)),
    Film(volume.Settings.SnapshotInterval, this->Pyramid.GetWorkspace())
{
  for (unsigned int block = 0; block < volume.Levels->GetNumberOfBlocks(); ++block)
  {
    this->Images.emplace_back(volume.Levels->GetBlock(block));
  }
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
  options.RecoverLostParts = this->Settings.Recovery != RecoveryType::NoRecovery;
  options.RecoverCavities = this->Settings.Recovery == RecoveryType::RecoverObjectsAndCavities;
  options.SeedRadius /= this->Pyramid.GetWorkspace().WorldUnit();
  this->Renew(request);
  this->ChooseEdgeLength(volume);
  this->ReadAttraction(volume.Levels);
  this->ReadComponentChoice();
}

SurfaceSegmentation::~SurfaceSegmentation() = default;

std::vector<Point> SurfaceSegmentation::SeedPositions() const
{
  return PositionsOf(this->Settings.SeedPositions, "Seed Positions", this->Pyramid.GetWorkspace(),
    this->Pyramid.SizeOfLevel0());
}

std::vector<Point> SurfaceSegmentation::AttractingPositions() const
{
  return PositionsOf(this->Settings.AttractingPositions, "Attracting Positions",
    this->Pyramid.GetWorkspace(), this->Pyramid.SizeOfLevel0());
}

void SurfaceSegmentation::ReadComponentChoice()
{
  CheckEnumeration(
    "Keep Components", this->Settings.KeepComponents, KeepComponentsType::LargeComponents);
  if (!(this->Settings.MinimumComponentVolume >= 0.0))
  {
    Refuse("Minimum Component Volume is ", this->Settings.MinimumComponentVolume,
      "; it must be 0 or more.");
  }
  this->Choice.Mode = this->Settings.KeepComponents;
  this->Choice.MinimumVolume = this->Settings.MinimumComponentVolume;
  if (this->Choice.Mode == KeepComponentsType::ComponentsAtPoints)
  {
    this->Choice.Places = PlacesOf(this->Request.InitialSurface, this->Request.AttractingPoints,
      this->Pyramid.GetWorkspace());
    for (const std::vector<Point>& more : { this->SeedPositions(), this->AttractingPositions() })
    {
      this->Choice.Places.insert(this->Choice.Places.end(), more.begin(), more.end());
    }
    if (this->Choice.Places.empty())
    {
      Refuse("Keep Components is \"At Points\", but there are none: add Seed Positions or Attracting "
             "Positions, or give seeds to input port 1 (Initial Surface), or points known to belong "
             "to the object to input port 2 (Attracting Points).");
    }
  }
}

void SurfaceSegmentation::ReadAttraction(vtkMultiBlockDataSet* blocks)
{
  std::vector<AttractingPoint> points;
  try
  {
    points = AttractingPointsOf(this->Request.AttractingPoints, this->Pyramid.GetWorkspace(),
      this->Pyramid.SizeOfLevel0());
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 2 (Attracting Points): ", error.what());
  }
  for (const Point& place : this->AttractingPositions())
  {
    points.emplace_back();
    points.back().Place = place;
  }
  if (!points.empty() && this->Settings.Options.PointAttractionWeight > 0.0)
  {
    this->Points = std::make_unique<PointAttraction>(
      std::move(points), this->Settings.Options.PointAttractionWeight);
  }
  if (this->Settings.Options.EdgeAttractionWeight > 0.0)
  {
    this->Edges = std::make_unique<EdgeLevels>(blocks, this->Request.EdgeSelection,
      this->Settings.End.NumberOfThreads,
      [this](double)
      {
        return this->Request.Progress(0.0, "Pyramid of the map of edges") &&
          !this->Request.Limit.IsOver();
      });
  }
}

std::array<double, 2> SurfaceSegmentation::RangeOfLevel(int level) const
{
  try
  {
    return this->Pyramid.Range(level);
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0: ", error.what());
  }
}

LevelImage SurfaceSegmentation::Load(int level, Executor& threads)
{
  LevelImage image;
  const double iso = this->Settings.Options.IsoValue;
  const std::array<double, 2> range = this->RangeOfLevel(std::max(level, 0));
  // As outside the image (Field.h): as far from the iso-value as any voxel is.
  const double away = std::max(range[1] - iso, iso - range[0]);
  const double background = this->Settings.Options.ObjectIsBright ? iso - away : iso + away;
  try
  {
    image = this->Pyramid.Load(level, iso, background, threads);
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0: ", error.what());
  }
  if (this->Edges)
  {
    image.Edges = this->Edges->Load(level, image.Size, threads);
  }
  if (this->Points)
  {
    this->Bent = this->Points->Bend(image, this->Settings.Options, threads);
    image.Values = this->Bent.data();
  }
  return image;
}

void SurfaceSegmentation::ChooseEdgeLength(const SegmentationVolume& volume)
{
  double factor = volume.FactorBelowLevel0;
  if (this->Settings.EdgeLength != 0.0 && !volume.EdgeLengthIsPlanned)
  {
    std::vector<double> units;
    for (int level = 0; level < this->Pyramid.NumberOfLevels(); ++level)
    {
      units.push_back(this->Pyramid.UnitInWorld(level));
    }
    EdgeLengthPreferences preferences;
    preferences.SamplingRatio = this->Settings.Options.SamplingRatio;
    const EdgeLengthPlan plan = PlanEdgeLength(this->Settings.EdgeLength, units, preferences);
    this->Settings.End.FinestLevel = plan.FinestLevel;
    this->Settings.Options.SamplingRatio = plan.SamplingRatio;
    factor = plan.ReductionFactor;
  }
  this->Pyramid.SetFactorBelowLevel0(factor);
}

void SurfaceSegmentation::ChooseLevels()
{
  const int last = this->Pyramid.NumberOfLevels() - 1;
  this->Coarsest = this->Settings.CoarsestLevel;
  if (this->Settings.CoarsestLevel == -1)
  {
    // A pyramid may go on to levels of a single voxel.
    for (this->Coarsest = last; !this->Pyramid.HasRoom(this->Coarsest);)
    {
      --this->Coarsest;
    }
  }
  const int finest = this->Settings.End.FinestLevel;
  if (this->Coarsest < 0 || this->Coarsest > last)
  {
    Refuse("Coarsest Level is ", this->Settings.CoarsestLevel,
      ", but the pyramid has the levels 0 to ", last, "; use one of them, or -1 for the last.");
  }
  if (this->Settings.EdgeLength != 0.0 && finest > this->Coarsest)
  {
    Refuse("Edge Length is ", this->Settings.EdgeLength, ", for which the finest level is ",
      finest, ", but Coarsest Level is ", this->Settings.CoarsestLevel,
      "; set it to that level, a coarser one, or -1 for the last.");
  }
  if (finest < -1 || finest > this->Coarsest)
  {
    Refuse("Finest Level is ", finest, "; it must lie between 0 and the coarsest level, ",
      this->Coarsest, ", or be -1 for a last division beyond the image.");
  }
  this->PreviewLevel = 0;
  while (this->PreviewLevel < this->Coarsest &&
    this->Pyramid.NumberOfVoxels(this->PreviewLevel) > VoxelsOfPreview)
  {
    ++this->PreviewLevel;
  }
}

void SurfaceSegmentation::ChooseEnd(int coarsestWithObject)
{
  this->PreviewLevel = std::min(this->PreviewLevel, coarsestWithObject);
  this->LastLevel = this->Settings.End.Preview
    ? std::max(this->Settings.End.FinestLevel, this->PreviewLevel)
    : this->Settings.End.FinestLevel;
}

void SurfaceSegmentation::WarnOfNaNs()
{
  if (this->MayHaveUntoldNaNs)
  {
    const std::string text = this->Pyramid.DescribeNaNsOfLevel0();
    if (!text.empty())
    {
      this->Request.Warn("Input port 0: " + text);
    }
  }
}

void SurfaceSegmentation::CheckIsoValue()
{
  const double iso = this->Settings.Options.IsoValue;
  const std::array<double, 2> range = this->RangeOfLevel(0);
  if (std::isnan(iso))
  {
    Refuse(
      "Iso Value is not set. Set it to the value that parts the object from the background; the "
      "voxels range from ",
      range[0], " to ", range[1], ".");
  }
  if (iso <= range[0] || iso >= range[1])
  {
    Refuse("Iso Value is ", iso, ", outside the range of the voxels, ", range[0], " to ", range[1],
      "; set it between them.");
  }
}

int SurfaceSegmentation::CoarsestLevelWithObject(int from)
{
  const bool bright = this->Settings.Options.ObjectIsBright;
  const double iso = this->Settings.Options.IsoValue;
  int level = from;
  for (; level > 0; --level)
  {
    const std::array<double, 2> range = this->RangeOfLevel(level);
    if (bright ? range[1] > iso : range[0] < iso)
    {
      break;
    }
  }
  return level;
}

int SurfaceSegmentation::CoarsestLevelThatHolds(int from)
{
  const SurfaceOptions& options = this->Settings.Options;
  // With recovery a surface that has vanished comes again, sooner than one that starts on a finer
  // level. Where other forces stop the surface, the object is not what its voxels' values tell.
  if (options.RecoverLostParts || !(options.IsopotentialWeight > 0.0) ||
    options.GradientWeight > 0.0 || this->Edges)
  {
    return from;
  }
  int level = from;
  while (level > std::max(this->LastLevel, 0) &&
    !this->Pyramid.HoldsObject(level, options.IsoValue, options.ObjectIsBright))
  {
    --level;
  }
  return level;
}

void SurfaceSegmentation::CheckObjectIsThere()
{
  if (this->Points)
  {
    this->ChooseEnd(this->Coarsest);
    return; // Every level shows what points mark.
  }
  const int level = this->CoarsestLevelWithObject(this->Coarsest);
  this->ChooseEnd(level);
  if (this->Settings.CoarsestLevel == -1 && level >= this->LastLevel)
  {
    this->Coarsest = this->CoarsestLevelThatHolds(level);
    return;
  }
  if (level == this->Coarsest)
  {
    return;
  }
  if (this->Settings.EdgeLength != 0.0 && this->Coarsest == this->LastLevel)
  {
    Refuse("Edge Length is ", this->Settings.EdgeLength, ", for which the finest level is ",
      this->LastLevel, ", but the object is too thin for it: no voxel is ",
      this->Settings.Options.ObjectIsBright ? "above" : "below", " Iso Value ",
      this->Settings.Options.IsoValue, " there. Give a shorter Edge Length.");
  }
  Refuse("the object has vanished at level ", this->Coarsest, ", the coarsest: no voxel is ",
    this->Settings.Options.ObjectIsBright ? "above" : "below", " Iso Value ",
    this->Settings.Options.IsoValue,
    " there. It is too thin for that level; set Coarsest Level to ", level,
    ", where it is still there, or less.");
}

void SurfaceSegmentation::Start(SurfaceEvolution& evolution, const LevelImage& image)
{
  const Workspace& space = this->Pyramid.GetWorkspace();
  std::vector<Point> seeds;
  if (this->Settings.Initialization == InitializationType::Seeds)
  {
    seeds = this->SeedPositions();
  }
  const bool hasPositions = !seeds.empty();
  try
  {
    switch (this->Settings.Initialization)
    {
      case InitializationType::Seeds:
      {
        const std::vector<Point> connected = SeedsOf(this->Request.InitialSurface, space);
        seeds.insert(seeds.begin(), connected.begin(), connected.end());
        evolution.StartSeeds(image, this->Coarsest, seeds);
        break;
      }
      case InitializationType::IsoSurface:
        evolution.StartSurface(
          image, this->Coarsest, ClosedIsoSurface(image, this->Settings.Options));
        break;
      case InitializationType::InputSurface:
        evolution.StartSurface(
          image, this->Coarsest, SurfaceOf(this->Request.InitialSurface, space));
        break;
      default:
        evolution.StartEnclosing(image, this->Coarsest);
        break;
    }
  }
  catch (const std::invalid_argument& error)
  {
    const bool isGiven = this->Settings.Initialization == InitializationType::InputSurface ||
      this->Settings.Initialization == InitializationType::Seeds;
    const bool ofPositions = hasPositions && !this->Request.InitialSurface;
    Refuse(ofPositions ? "Seed Positions: " : isGiven ? "Input port 1 (Initial Surface): " : "",
      error.what());
  }
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
}

void SurfaceSegmentation::Run()
{
  const int before = this->Coarsest;
  this->ChooseLevels();
  this->CheckIsoValue();
  this->CheckObjectIsThere();
  if (!this->Evolution)
  {
    this->WarnOfNaNs(); // Once for all runs that go on from this one.
  }
  // Where a run begins may depend on where it is to end; then nothing of the last one serves.
  if (!this->Evolution || this->Coarsest != before)
  {
    this->Begin();
  }
  this->Found.SetHandedOver(nullptr);
  if (!this->Found.HasAtRest(this->LastLevel))
  {
    // What the evolution refers to stays in its place.
    this->Threads.emplace(this->Settings.End.NumberOfThreads);
    this->Watcher.emplace(
      this->Request.Progress, this->Coarsest, this->LastLevel, this->Request.Limit);
    this->Watcher->AfterIteration = [this](const Monitor::Status& status)
    {
      this->Film.Offer(*this->Evolution, status.Level, this->Pyramid.UnitInWorld(status.Level),
        status.Iteration, this->Found);
    };
    this->Threads->Run([this] { this->RunLevels(); });
  }
  if (!this->Request.IsStep)
  {
    this->Found.WarnOf(
      this->LastLevel, this->HasRecovery() && !this->Settings.End.Preview, this->Request.Warn);
  }
}

bool SurfaceSegmentation::CanGoOn() const
{
  return this->GoesOn && this->Reached > 0 && !this->Evolution->IsStopped();
}

void SurfaceSegmentation::Begin()
{
  this->Evolution.reset();
  this->GoesOn = false;
  this->Found = SegmentationResults(this->Pyramid.NumberOfLevels(), this->Coarsest,
    this->Pyramid.GetWorkspace(), this->Settings.Profile);
  this->Found.SetPreviewLevel(this->PreviewLevel);
}

void SurfaceSegmentation::RunLevels()
{
  if (!this->Evolution)
  {
    this->Evolution =
      std::make_unique<SurfaceEvolution>(this->Settings.Options, *this->Threads, *this->Watcher);
    this->Reached = this->Coarsest + 1;
    this->GoesOn = true;
  }
  this->Evolution->StartClock(this->Request.Started);
  while (this->GoesOn && this->Reached > this->LastLevel)
  {
    const int level = this->Reached - 1;
    if (!this->Watcher->LoadLevel(level))
    {
      this->HandOverStopped(level);
      break;
    }
    const LevelImage image = this->Load(level, *this->Threads);
    if (level == this->Settings.End.FinestLevel)
    {
      this->Evolution->SetMeanEdgeLength(
        this->Settings.EdgeLength / this->Pyramid.GetWorkspace().WorldUnit());
    }
    if (level == this->Coarsest)
    {
      this->Start(*this->Evolution, image);
    }
    else if (!this->Evolution->Divide(image, level))
    {
      this->HandOverStopped(level);
      break;
    }
    this->Film.Offer(
      *this->Evolution, level, this->Pyramid.UnitInWorld(level), 0, this->Found);
    this->GoesOn = this->RunLevel(level);
    this->Reached = level;
  }
  this->Found.SetRows(this->Evolution->History());
}

bool SurfaceSegmentation::RunLevel(int level)
{
  const StopReason reason = this->Evolution->Run();
  SegmentationResults::Level result;
  result.IsAtRest = reason != StopReason::Cancelled;
  SurfaceDescription& description = result.Description;
  description.Level = level;
  description.Unit = this->Pyramid.UnitInWorld(level);
  description.Iterations = this->Evolution->Iterations();
  description.StopReason = result.IsAtRest ? Describe(reason) : this->WhyStopped();
  if (level < this->Coarsest)
  {
    const SurfaceEvolution::LostParts lost = this->Evolution->Lost();
    description.LostParts = lost.Found;
    description.RecoveredParts = lost.Enclosed;
    description.MissingParts = lost.Missing;
    description.MissingBoundary = lost.MissingBoundary;
    description.LostCavities = lost.FoundCavities;
    description.RecoveredCavities = lost.EnclosedCavities;
  }
  const SurfaceResult surface = this->Evolution->Result();
  const SurfaceResult kept = KeepChosen(surface, this->Choice, this->Pyramid.GetWorkspace());
  result.KeepsNone = kept.Points.empty() && !surface.Points.empty();
  result.Surface = MakePolyData(kept, description, this->Pyramid.GetWorkspace());
  this->Found.SetLevel(level, result);
  this->Evolution->EndLevel();
  // With recovery a finer level may find again what has vanished.
  return reason == StopReason::Converged || reason == StopReason::LimitCycle ||
    reason == StopReason::IterationLimit ||
    (reason == StopReason::Vanished && this->Settings.Options.RecoverLostParts);
}

std::string SurfaceSegmentation::WhyStopped() const
{
  return this->Watcher->IsOutOfTime() ? TimeLimitReason : Describe(StopReason::Cancelled);
}

void SurfaceSegmentation::HandOverStopped(int level)
{
  if (level == this->Coarsest)
  {
    this->Found.SetHandedOver(MakeStopped(level, this->WhyStopped()));
    return;
  }
  // The block of the level above is a surface at rest and stays one.
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(this->Found.SurfaceOf(level + 1));
  SetStopReason(surface, this->WhyStopped());
  this->Found.SetHandedOver(surface);
}
}
