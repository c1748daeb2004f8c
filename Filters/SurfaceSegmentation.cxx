// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSegmentation.h"

#include "Core/Common/Refuse.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "GivenPositions.h"
#include "InitialSurfaces.h"
#include "SurfaceOutput.h"
#include "vtkDeformableSurface.h"

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
void CheckEnumeration(const char* name, int value, int last)
{
  if (value < 0 || value > last)
  {
    Refuse(name, " is ", value, "; it must be 0 to ", last, ".");
  }
}

/// Image Pyramid has counted them, and tells it itself where it is a filter of the user's.
bool MayHaveNaNsToTell(vtkMultiBlockDataSet* blocks, const SegmentationSettings& settings)
{
  vtkDataArray* counted = blocks->GetFieldData()->GetArray("NaNVoxels");
  return !counted || (settings.LevelsAreOwn && counted->GetTuple1(0) > 0.0);
}

/// The levels, with errors that name the port.
PyramidLevels ReadLevels(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, const SegmentationSettings& settings)
{
  CheckEnumeration("Metric", settings.Metric, vtkDeformableSurface::World);
  try
  {
    return PyramidLevels(
      blocks, selection, static_cast<Metric>(settings.Metric), settings.NaNIsBackground);
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0: ", error.what());
  }
}

}

SurfaceSegmentation::SurfaceSegmentation(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, const SegmentationSettings& settings)
  : Settings(settings), MayHaveUntoldNaNs(MayHaveNaNsToTell(blocks, settings)),
    Pyramid(ReadLevels(blocks, selection, settings)),
    Film(settings.SnapshotInterval, this->Pyramid.GetWorkspace())
{
  for (unsigned int block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    this->Images.emplace_back(blocks->GetBlock(block));
  }
  CheckEnumeration("Initialization", settings.Initialization, vtkDeformableSurface::InputSurface);
  CheckEnumeration("Border Value", settings.BorderValue, vtkDeformableSurface::Replicate);
  CheckEnumeration(
    "Recovery", settings.Recovery, vtkDeformableSurface::RecoverObjectsAndCavities);
  if (settings.Options.MaximumNumberOfIterations < 1)
  {
    Refuse("Maximum Number Of Iterations is ", settings.Options.MaximumNumberOfIterations,
      "; it must be at least 1.");
  }
  if (settings.SnapshotInterval < 0)
  {
    Refuse("Snapshot Interval is ", settings.SnapshotInterval, "; it must be 0 (off) or more.");
  }
  if (settings.Options.SeedRadius < 0.0 || !std::isfinite(settings.Options.SeedRadius))
  {
    Refuse("Seed Radius is ", settings.Options.SeedRadius, "; it must be 0 (automatic) or more.");
  }
  this->Settings.Options.BorderValue = static_cast<Border>(settings.BorderValue);
  this->Settings.Options.RecoverLostParts =
    settings.Recovery != vtkDeformableSurface::NoRecovery;
  this->Settings.Options.RecoverCavities =
    settings.Recovery == vtkDeformableSurface::RecoverObjectsAndCavities;
  this->Settings.Options.SeedRadius /= this->Pyramid.GetWorkspace().WorldUnit();
  this->ChooseEdgeLength();
  this->ReadAttraction(blocks);
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
    "Keep Components", this->Settings.KeepComponents, vtkDeformableSurface::LargeComponents);
  if (!(this->Settings.MinimumComponentVolume >= 0.0))
  {
    Refuse("Minimum Component Volume is ", this->Settings.MinimumComponentVolume,
      "; it must be 0 or more.");
  }
  this->Choice.Mode = this->Settings.KeepComponents;
  this->Choice.MinimumVolume = this->Settings.MinimumComponentVolume;
  if (this->Choice.Mode == vtkDeformableSurface::ComponentsAtPoints)
  {
    this->Choice.Places = PlacesOf(this->Settings.InitialSurface, this->Settings.AttractingPoints,
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
    points = AttractingPointsOf(this->Settings.AttractingPoints, this->Pyramid.GetWorkspace(),
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
    this->Edges = std::make_unique<EdgeLevels>(blocks, this->Settings.EdgeSelection,
      this->Settings.NumberOfThreads,
      [this](double)
      {
        return this->Settings.Progress(0.0, "Pyramid of the map of edges") &&
          !this->Settings.Limit.IsOver();
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

void SurfaceSegmentation::ChooseEdgeLength()
{
  if (this->Settings.EdgeLength != 0.0 && !this->Settings.EdgeLengthIsPlanned)
  {
    std::vector<double> units;
    for (int level = 0; level < this->Pyramid.NumberOfLevels(); ++level)
    {
      units.push_back(this->Pyramid.UnitInWorld(level));
    }
    EdgeLengthPreferences preferences;
    preferences.SamplingRatio = this->Settings.Options.SamplingRatio;
    const EdgeLengthPlan plan = PlanEdgeLength(this->Settings.EdgeLength, units, preferences);
    this->Settings.FinestLevel = plan.FinestLevel;
    this->Settings.Options.SamplingRatio = plan.SamplingRatio;
    this->Settings.FactorBelowLevel0 = plan.ReductionFactor;
  }
  this->Pyramid.SetFactorBelowLevel0(this->Settings.FactorBelowLevel0);
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
  const int finest = this->Settings.FinestLevel;
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
  this->LastLevel = this->Settings.Preview
    ? std::max(this->Settings.FinestLevel, this->PreviewLevel)
    : this->Settings.FinestLevel;
}

void SurfaceSegmentation::WarnOfNaNs()
{
  if (this->MayHaveUntoldNaNs)
  {
    const std::string text = this->Pyramid.DescribeNaNsOfLevel0();
    if (!text.empty())
    {
      this->Settings.Warn("Input port 0: " + text);
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
  if (this->Settings.Initialization == vtkDeformableSurface::Seeds)
  {
    seeds = this->SeedPositions();
  }
  const bool hasPositions = !seeds.empty();
  try
  {
    switch (this->Settings.Initialization)
    {
      case vtkDeformableSurface::Seeds:
      {
        const std::vector<Point> connected = SeedsOf(this->Settings.InitialSurface, space);
        seeds.insert(seeds.begin(), connected.begin(), connected.end());
        evolution.StartSeeds(image, this->Coarsest, seeds);
        break;
      }
      case vtkDeformableSurface::IsoSurface:
        evolution.StartSurface(
          image, this->Coarsest, ClosedIsoSurface(image, this->Settings.Options));
        break;
      case vtkDeformableSurface::InputSurface:
        evolution.StartSurface(
          image, this->Coarsest, SurfaceOf(this->Settings.InitialSurface, space));
        break;
      default:
        evolution.StartEnclosing(image, this->Coarsest);
        break;
    }
  }
  catch (const std::invalid_argument& error)
  {
    const bool isGiven = this->Settings.Initialization == vtkDeformableSurface::InputSurface ||
      this->Settings.Initialization == vtkDeformableSurface::Seeds;
    const bool ofPositions = hasPositions && !this->Settings.InitialSurface;
    Refuse(ofPositions ? "Seed Positions: " : isGiven ? "Input port 1 (Initial Surface): " : "",
      error.what());
  }
}

void SurfaceSegmentation::Renew(const SegmentationRequest& request)
{
  const int planned = this->Settings.FinestLevel;
  static_cast<SegmentationRequest&>(this->Settings) = request;
  if (this->Settings.EdgeLength != 0.0)
  {
    this->Settings.FinestLevel = planned;
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
    this->Threads.emplace(this->Settings.NumberOfThreads);
    this->Watcher.emplace(
      this->Settings.Progress, this->Coarsest, this->LastLevel, this->Settings.Limit);
    this->Watcher->AfterIteration = [this](const Monitor::Status& status)
    {
      this->Film.Offer(*this->Evolution, status.Level, this->Pyramid.UnitInWorld(status.Level),
        status.Iteration, this->Found);
    };
    this->Threads->Run([this] { this->RunLevels(); });
  }
  const std::string warning =
    this->Found.WarningOf(this->LastLevel, this->WantsAllParts());
  if (!warning.empty() && !this->Settings.IsStep)
  {
    this->Settings.Warn(warning);
  }
}

bool SurfaceSegmentation::WantsAllParts() const
{
  return this->Settings.Options.RecoverLostParts && !this->Settings.Preview;
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
  this->Evolution->StartClock(this->Settings.Started);
  while (this->GoesOn && this->Reached > this->LastLevel)
  {
    const int level = this->Reached - 1;
    if (!this->Watcher->LoadLevel(level))
    {
      this->HandOverStopped(level);
      break;
    }
    const LevelImage image = this->Load(level, *this->Threads);
    if (level == this->Settings.FinestLevel)
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
