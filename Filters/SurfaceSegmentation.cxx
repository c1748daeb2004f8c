// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSegmentation.h"

#include "Core/EdgeLengthPlan.h"
#include "Core/Refuse.h"
#include "HostThreads.h"
#include "InitialSurfaces.h"
#include "SurfaceOutput.h"
#include "vtkDeformableSurface.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

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

/// The levels, with errors that name the port.
PyramidLevels ReadLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection, int metric)
{
  CheckEnumeration("Metric", metric, vtkDeformableSurface::World);
  try
  {
    return PyramidLevels(blocks, selection, static_cast<Metric>(metric));
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0: ", error.what());
  }
}

}

SurfaceSegmentation::SurfaceSegmentation(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, const SegmentationSettings& settings)
  : Settings(settings), Pyramid(ReadLevels(blocks, selection, settings.Metric)),
    Finest(vtkSmartPointer<vtkPolyData>::New()),
    Blocks(vtkSmartPointer<vtkMultiBlockDataSet>::New()), Table(vtkSmartPointer<vtkTable>::New()),
    Film(settings.SnapshotInterval, this->Pyramid.GetWorkspace())
{
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
    if (this->Choice.Places.empty())
    {
      Refuse("Keep Components is \"At Points\", but there are none: give seeds to input port 1 "
             "(Initial Surface), or points known to belong to the object to input port 2 "
             "(Attracting Points).");
    }
  }
}

void SurfaceSegmentation::ReadAttraction(vtkMultiBlockDataSet* blocks)
{
  try
  {
    std::vector<AttractingPoint> points = AttractingPointsOf(this->Settings.AttractingPoints,
      this->Pyramid.GetWorkspace(), this->Pyramid.SizeOfLevel0());
    if (!points.empty() && this->Settings.Options.PointAttractionWeight > 0.0)
    {
      this->Points = std::make_unique<PointAttraction>(
        std::move(points), this->Settings.Options.PointAttractionWeight);
    }
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 2 (Attracting Points): ", error.what());
  }
  if (this->Settings.Options.EdgeAttractionWeight > 0.0)
  {
    this->Edges = std::make_unique<EdgeLevels>(blocks, this->Settings.EdgeSelection,
      this->Settings.NumberOfThreads,
      [this](double) { return this->Settings.Progress(0.0, "Pyramid of the map of edges"); });
  }
}

LevelImage SurfaceSegmentation::Load(int level, Executor& threads)
{
  LevelImage image;
  try
  {
    image = this->Pyramid.Load(level, this->Settings.Options.IsoValue, threads);
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
  this->LastLevel = this->Settings.FinestLevel;
  if (this->Coarsest < 0 || this->Coarsest > last)
  {
    Refuse("Coarsest Level is ", this->Settings.CoarsestLevel,
      ", but the pyramid has the levels 0 to ", last, "; use one of them, or -1 for the last.");
  }
  if (this->Settings.EdgeLength != 0.0 && this->LastLevel > this->Coarsest)
  {
    Refuse("Edge Length is ", this->Settings.EdgeLength, ", for which the finest level is ",
      this->LastLevel, ", but Coarsest Level is ", this->Settings.CoarsestLevel,
      "; set it to that level, a coarser one, or -1 for the last.");
  }
  if (this->LastLevel < -1 || this->LastLevel > this->Coarsest)
  {
    Refuse("Finest Level is ", this->LastLevel, "; it must lie between 0 and the coarsest level, ",
      this->Coarsest, ", or be -1 for a last division beyond the image.");
  }
}

unsigned int SurfaceSegmentation::BlockOf(int level) const
{
  return static_cast<unsigned int>(level < 0 ? this->Pyramid.NumberOfLevels() : level);
}

void SurfaceSegmentation::CheckIsoValue()
{
  const double iso = this->Settings.Options.IsoValue;
  const std::array<double, 2> range = this->Pyramid.Range(0);
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
    const std::array<double, 2> range = this->Pyramid.Range(level);
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
    return; // Every level shows what points mark.
  }
  const int level = this->CoarsestLevelWithObject(this->Coarsest);
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
  try
  {
    switch (this->Settings.Initialization)
    {
      case vtkDeformableSurface::Seeds:
        evolution.StartSeeds(image, this->Coarsest, SeedsOf(this->Settings.InitialSurface, space));
        break;
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
    Refuse(isGiven ? "Input port 1 (Initial Surface): " : "", error.what());
  }
}

void SurfaceSegmentation::WarnOfResult(const SurfaceDescription& end, bool keepsNone)
{
  // The field data tell the rest; what is worth a warning needs another choice to be made.
  constexpr double notable = 0.01;
  if (end.StopReason == Describe(StopReason::Vanished))
  {
    this->Settings.Warn(Join("Nothing is left of the surface at level ", end.Level,
      ": the object is too thin for it. ",
      this->Coarsest > 0
        ? "Set Coarsest Level to a finer level."
        : "No level is finer: check Iso Value and Object Is Bright, or resample the image."));
  }
  else if (keepsNone)
  {
    this->Settings.Warn(
      Join("Level ", end.Level, ": Keep Components leaves none of the components."));
  }
  else if (end.MissingBoundary > notable && this->Settings.Options.RecoverLostParts)
  {
    const int lost = end.LostParts + end.LostCavities;
    this->Settings.Warn(Join(std::lround(100.0 * end.MissingBoundary),
      " % of the object's boundary at level ", end.Level, " is not on the surface: of ", lost,
      lost == 1 ? " part" : " parts", " that coarser levels had lost ", end.MissingParts,
      end.MissingParts == 1 ? " is" : " are",
      " still missing, and thin ends of others. They are too thin for triangles of this size, or too "
      "near to the rest. ",
      end.Level > 0
        ? "Set Finest Level to a finer level."
        : (end.Level == 0 ? "Set Finest Level to -1, which has smaller ones, or resample the image."
                          : "Resample the image more finely.")));
  }
}

bool SurfaceSegmentation::RunLevel(SurfaceEvolution& evolution, int level)
{
  const StopReason reason = evolution.Run();
  SurfaceDescription description;
  description.Level = level;
  description.Unit = this->Pyramid.UnitInWorld(level);
  description.Iterations = evolution.Iterations();
  description.StopReason = Describe(reason);
  if (level < this->Coarsest)
  {
    const SurfaceEvolution::LostParts lost = evolution.Lost();
    description.LostParts = lost.Found;
    description.RecoveredParts = lost.Enclosed;
    description.MissingParts = lost.Missing;
    description.MissingBoundary = lost.MissingBoundary;
    description.LostCavities = lost.FoundCavities;
    description.RecoveredCavities = lost.EnclosedCavities;
  }
  const SurfaceResult surface = evolution.Result();
  const SurfaceResult kept = KeepChosen(surface, this->Choice, this->Pyramid.GetWorkspace());
  this->Finest = MakePolyData(kept, description, this->Pyramid.GetWorkspace());
  this->Blocks->SetBlock(this->BlockOf(level), this->Finest);
  evolution.EndLevel();
  const bool goesOn = reason == StopReason::Converged || reason == StopReason::LimitCycle ||
    reason == StopReason::IterationLimit ||
    (reason == StopReason::Vanished && this->Settings.Options.RecoverLostParts);
  if (reason != StopReason::Cancelled && (level == this->LastLevel || !goesOn))
  {
    this->WarnOfResult(description, kept.Points.empty() && !surface.Points.empty());
  }
  return goesOn;
}

void SurfaceSegmentation::Run()
{
  this->ChooseLevels();
  this->CheckIsoValue();
  this->CheckObjectIsThere();
  for (int level = std::min(this->LastLevel, 0); level < this->Pyramid.NumberOfLevels(); ++level)
  {
    this->Blocks->SetBlock(this->BlockOf(level), nullptr);
    this->Blocks->GetMetaData(this->BlockOf(level))
      ->Set(vtkCompositeDataSet::NAME(), Join("Level ", level).c_str());
  }

  HostThreads threads(this->Settings.NumberOfThreads);
  ProgressMonitor monitor(this->Settings.Progress, this->Coarsest, this->LastLevel);
  threads.Run([&] { this->RunLevels(threads, monitor); });
}

void SurfaceSegmentation::RunLevels(HostThreads& threads, ProgressMonitor& monitor)
{
  SurfaceEvolution evolution(this->Settings.Options, threads, monitor);
  evolution.StartClock(this->Settings.Started);
  monitor.AfterIteration = [&](const Monitor::Status& status)
  {
    this->Film.Offer(
      evolution, status.Level, this->Pyramid.UnitInWorld(status.Level), status.Iteration);
  };
  for (int level = this->Coarsest; level >= this->LastLevel; --level)
  {
    if (!monitor.LoadLevel(level))
    {
      this->MarkCancelled(level);
      break;
    }
    const LevelImage image = this->Load(level, threads);
    if (level == this->LastLevel)
    {
      evolution.SetMeanEdgeLength(
        this->Settings.EdgeLength / this->Pyramid.GetWorkspace().WorldUnit());
    }
    if (level == this->Coarsest)
    {
      this->Start(evolution, image);
    }
    else if (!evolution.Divide(image, level))
    {
      this->MarkCancelled(level);
      break;
    }
    this->Film.Offer(evolution, level, this->Pyramid.UnitInWorld(level), 0);
    if (!this->RunLevel(evolution, level))
    {
      break;
    }
  }
  this->Table =
    MakeHistory(evolution.History(), this->Pyramid.GetWorkspace(), this->Settings.Profile);
}

void SurfaceSegmentation::MarkCancelled(int level)
{
  if (level == this->Coarsest)
  {
    this->Finest = MakeCancelled(level);
    return;
  }
  // The block of the level above is a surface at rest and stays one.
  auto finest = vtkSmartPointer<vtkPolyData>::New();
  finest->ShallowCopy(this->Finest);
  SetStopReason(finest, Describe(StopReason::Cancelled));
  this->Finest = finest;
}
}
