// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSegmentation.h"

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
PyramidLevels ReadLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection)
{
  try
  {
    return PyramidLevels(blocks, selection);
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0: ", error.what());
  }
}

/// Tells the host of every iteration. A level has about three times the vertices of the one above.
class ProgressMonitor final : public Monitor
{
public:
  ProgressMonitor(const SegmentationSettings& settings, int coarsest, int finest)
    : Settings(settings), Coarsest(coarsest), Finest(finest)
  {
  }

  std::function<void(const Status&)> AfterIteration;

  bool Continue(const Status& status) override
  {
    if (status.Iteration > 0)
    {
      this->AfterIteration(status);
    }
    double before = 0.0;
    double total = 0.0;
    for (int level = this->Coarsest; level >= this->Finest; --level)
    {
      const double weight = std::pow(3.0, this->Coarsest - level);
      before += level > status.Level ? weight : 0.0;
      total += weight;
    }
    const double own = std::pow(3.0, this->Coarsest - status.Level);
    const double share = (before + own * std::clamp(status.Fraction, 0.0, 1.0)) / total;
    return this->Settings.Progress(share,
      Join("Level ", status.Level, ", iteration ", status.Iteration, ", ", status.Vertices,
        " vertices"));
  }

private:
  const SegmentationSettings& Settings;
  int Coarsest;
  int Finest;
};
}

SurfaceSegmentation::SurfaceSegmentation(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, const SegmentationSettings& settings)
  : Settings(settings), Pyramid(ReadLevels(blocks, selection)),
    Finest(vtkSmartPointer<vtkPolyData>::New()),
    Blocks(vtkSmartPointer<vtkMultiBlockDataSet>::New()), Table(vtkSmartPointer<vtkTable>::New()),
    Film(settings.SnapshotInterval, this->Pyramid.GetWorkspace())
{
  CheckEnumeration("Initialization", settings.Initialization, vtkDeformableSurface::InputSurface);
  CheckEnumeration("BorderValue", settings.BorderValue, vtkDeformableSurface::Replicate);
  CheckEnumeration(
    "Recovery", settings.Recovery, vtkDeformableSurface::RecoverObjectsAndCavities);
  if (settings.Options.MaximumNumberOfIterations < 1)
  {
    Refuse("MaximumNumberOfIterations is ", settings.Options.MaximumNumberOfIterations,
      "; it must be at least 1.");
  }
  if (settings.SnapshotInterval < 0)
  {
    Refuse("SnapshotInterval is ", settings.SnapshotInterval, "; it must be 0 (off) or more.");
  }
  if (settings.Options.SeedRadius < 0.0 || !std::isfinite(settings.Options.SeedRadius))
  {
    Refuse("SeedRadius is ", settings.Options.SeedRadius, "; it must be 0 (automatic) or more.");
  }
  this->Settings.Options.BorderValue = static_cast<Border>(settings.BorderValue);
  this->Settings.Options.RecoverLostParts =
    settings.Recovery != vtkDeformableSurface::NoRecovery;
  this->Settings.Options.RecoverCavities =
    settings.Recovery == vtkDeformableSurface::RecoverObjectsAndCavities;
  this->Settings.Options.SeedRadius /= this->Pyramid.GetWorkspace().WorldUnit();
  this->ReadAttraction(blocks);
  this->ReadComponentChoice();
}

SurfaceSegmentation::~SurfaceSegmentation() = default;

void SurfaceSegmentation::ReadComponentChoice()
{
  CheckEnumeration(
    "KeepComponents", this->Settings.KeepComponents, vtkDeformableSurface::LargeComponents);
  if (!(this->Settings.MinimumComponentVolume >= 0.0))
  {
    Refuse("MinimumComponentVolume is ", this->Settings.MinimumComponentVolume,
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
      Refuse("KeepComponents is 2, those at points, but there are none: give seeds to input port "
             "1, or points known to belong to the object to input port 2.");
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
    Refuse("Input port 2: ", error.what());
  }
  if (this->Settings.Options.EdgeAttractionWeight > 0.0)
  {
    this->Edges = std::make_unique<EdgeLevels>(
      blocks, this->Settings.EdgeSelection, this->Settings.NumberOfThreads);
  }
}

LevelImage SurfaceSegmentation::Load(int level, Executor& threads)
{
  LevelImage image;
  try
  {
    image = this->Pyramid.Load(level, threads);
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

void SurfaceSegmentation::ChooseLevels()
{
  const int last = this->Pyramid.NumberOfLevels() - 1;
  this->Coarsest = this->Settings.CoarsestLevel == -1 ? last : this->Settings.CoarsestLevel;
  this->LastLevel = this->Settings.FinestLevel;
  if (this->Coarsest < 0 || this->Coarsest > last)
  {
    Refuse("CoarsestLevel is ", this->Settings.CoarsestLevel,
      ", but the pyramid has the levels 0 to ", last, "; use one of them, or -1 for the last.");
  }
  if (this->LastLevel < -1 || this->LastLevel > this->Coarsest)
  {
    Refuse("FinestLevel is ", this->LastLevel, "; it must lie between 0 and the coarsest level, ",
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
      "IsoValue is not set. Set it to the value that parts the object from the background; the "
      "voxels range from ",
      range[0], " to ", range[1], ".");
  }
  if (iso <= range[0] || iso >= range[1])
  {
    Refuse("IsoValue is ", iso, ", outside the range of the voxels, ", range[0], " to ", range[1],
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
    if (bright ? static_cast<float>(range[1]) > iso : static_cast<float>(range[0]) < iso)
    {
      break;
    }
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
  if (level == this->Coarsest)
  {
    return;
  }
  if (this->Settings.CoarsestLevel == -1 && level >= this->LastLevel)
  {
    this->Coarsest = level;
    return;
  }
  Refuse("the object has vanished at level ", this->Coarsest, ", the coarsest: no voxel is ",
    this->Settings.Options.ObjectIsBright ? "above" : "below", " IsoValue ",
    this->Settings.Options.IsoValue, " there. It is too thin for that level; set CoarsestLevel to ",
    level, ", where it is still there, or less.");
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
    Refuse(isGiven ? "Input port 1: " : "", error.what());
  }
}

void SurfaceSegmentation::WarnOfLostParts(int level, const SurfaceEvolution::LostParts& lost)
{
  // The field data tell it of every level; only what stays lost in the end is worth a warning.
  const int missing = lost.Found - lost.Enclosed;
  if (missing > 0 && level == this->LastLevel)
  {
    this->Settings.Warn(Join("Level ", level, " shows ", lost.Found, " part",
      lost.Found == 1 ? "" : "s", " of the object that the surface lost at level ", level + 1, "; ",
      missing, missing == 1 ? " is" : " are", " not found again. ",
      this->Settings.Options.RecoverLostParts ? "They lie too close to the surface for one of their "
                                                "own; a finer CoarsestLevel may keep more."
                                              : "Turn Recovery on to find them."));
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
    description.LostCavities = lost.FoundCavities;
    description.RecoveredCavities = lost.EnclosedCavities;
  }
  const SurfaceResult surface = evolution.Result();
  const SurfaceResult kept = KeepChosen(surface, this->Choice, this->Pyramid.GetWorkspace());
  if (kept.Points.empty() && !surface.Points.empty())
  {
    this->Settings.Warn(Join("Level ", level, ": KeepComponents leaves none of the components."));
  }
  this->Finest = MakePolyData(kept, description, this->Pyramid.GetWorkspace());
  this->Blocks->SetBlock(this->BlockOf(level), this->Finest);
  this->Table =
    MakeHistory(evolution.History(), this->Pyramid.GetWorkspace(), this->Settings.Profile);
  // With recovery a finer level may find again what has vanished.
  if (reason == StopReason::Vanished &&
    (level == this->LastLevel || !this->Settings.Options.RecoverLostParts))
  {
    this->Settings.Warn(Join("Nothing is left of the surface at level ", level,
      ": the object is too thin for it. Set CoarsestLevel to a finer level."));
  }
  return reason == StopReason::Converged || reason == StopReason::IterationLimit ||
    (reason == StopReason::Vanished && this->Settings.Options.RecoverLostParts);
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
  ProgressMonitor monitor(this->Settings, this->Coarsest, this->LastLevel);
  threads.Run(
    [&]
    {
      SurfaceEvolution evolution(this->Settings.Options, threads, monitor);
      monitor.AfterIteration = [&](const Monitor::Status& status)
      {
        this->Film.Offer(
          evolution, status.Level, this->Pyramid.UnitInWorld(status.Level), status.Iteration);
      };
      for (int level = this->Coarsest; level >= this->LastLevel; --level)
      {
        const LevelImage image = this->Load(level, threads);
        if (level == this->Coarsest)
        {
          this->Start(evolution, image);
        }
        else
        {
          evolution.Divide(image, level);
          this->WarnOfLostParts(level, evolution.Lost());
        }
        this->Film.Offer(evolution, level, this->Pyramid.UnitInWorld(level), 0);
        if (!this->RunLevel(evolution, level))
        {
          break;
        }
      }
    });
}
}
