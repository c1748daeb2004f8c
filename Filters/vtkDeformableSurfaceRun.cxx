// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What vtkDeformableSurface does at RequestData(): what is asked for, whether it is kept, whether
// the last run goes on or another one begins.

#include "vtkDeformableSurface.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Refuse.h"
#include "Host/Deadline.h"
#include "Host/PrefixErrors.h"
#include "Host/VersionCompatibility.h"
#include "Host/WholeInput.h"
#include "Input/InputImage.h"
#include "Input/SlabInput.h"
#include "Input/Workspace.h"
#include "Output/SegmentationResults.h"
#include "Output/SurfaceOutput.h"
#include "Pyramid/BuildPyramid.h"
#include "Ranks/Ranks.h"
#include "Run/SegmentationCache.h"
#include "Run/SurfaceSegmentation.h"
#include "Settings/SegmentationSettings.h"
#include "Settings/SegmentationVolume.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace
{
/** Share of the progress that the pyramid takes where it is built here. */
constexpr double PyramidShare = 0.02;
/** Share of that that the reading takes where the image comes in slabs. */
constexpr double ReadingShare = 0.5;

/** Whether the levels are made here: the data of input port 0 are no pyramid. */
bool BuildsPyramid(vtkDataObject* input)
{
  return vtkMultiBlockDataSet::SafeDownCast(input) == nullptr;
}

/** The outputs of a run that was stopped before it had a level. */
void FillByNothing(vtkInformationVector* output, bool isAborted, bool withPhases)
{
  volumic::SegmentationResults nothing(0, 0, volumic::Workspace(), {}, withPhases);
  nothing.SetStoppedSurface(volumic::MakeStopped(
    0, isAborted ? Describe(volumic::StopReason::Cancelled) : volumic::TimeLimitReason));
  nothing.FillOutputs(0, output);
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> vtkDeformableSurface::ReadInput(
  vtkDataObject* input, bool takesCells, volumic::SegmentationVolume& volume)
{
  // What ranks had in pieces is in scratch memory already.
  if (this->Internals->Memory.Limit() == 0 || this->Internals->All->AreMany())
  {
    return input;
  }
  volumic::SlabInput::Request request;
  request.Limit = this->Internals->Memory.Limit();
  request.Selection = volume.Selection;
  request.SelectedComponent = volume.Settings.SelectedComponent;
  request.TakesCells = takesCells;
  request.GoOn = [this](double share)
  { return this->ShowPyramidProgress(ReadingShare * share, "Reading the image"); };
  const volumic::SlabInput::Result slabs = volumic::PrefixErrors(
    "Input port 0: ", [&] { return volumic::SlabInput(this).Read(request); });
  const std::string whole = volumic::SlabInput(this).DescribeWhole();
  if (!whole.empty() && !std::exchange(this->Internals->HasToldOfWhole, true))
  {
    this->Warn("Input port 0: " + whole);
  }
  if (slabs.IsStopped || !slabs.Image)
  {
    return slabs.IsStopped ? nullptr : input;
  }
  volume.Selection = slabs.Selection;
  volume.Settings.SelectedComponent = -1; // It has been selected.
  return slabs.Image;
}

//------------------------------------------------------------------------------
volumic::SegmentationVolume vtkDeformableSurface::VolumeAsSet()
{
  volumic::SegmentationVolume volume;
  volume.Selection = this->GetInputArrayInformation(0);
  volume.Settings = this->Internals->Settings;
  volume.Settings.End.FinestLevel = this->Internals->Settings.LastLevel();
  volume.Settings.Range(); // Refused before anything is read.
  return volume;
}

//------------------------------------------------------------------------------
volumic::PyramidRequest vtkDeformableSurface::PyramidAsSet()
{
  const volumic::SegmentationSettings& settings = this->Internals->Settings;
  volumic::PyramidRequest request;
  request.Range = settings.Range();
  request.NaNIsBackground = settings.NaNIsBackground;
  request.NumberOfThreads = settings.End.NumberOfThreads;
  request.Progress = [this](double share, const std::string&)
  { return this->ShowPyramidProgress(share); };
  return request;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::MakeLevels(const volumic::PyramidOptions& pyramid, vtkImageData* image,
  volumic::SegmentationVolume& volume)
{
  volumic::SegmentationSettings& settings = volume.Settings;
  volumic::PyramidRequest request = this->PyramidAsSet();
  request.Levels = pyramid;
  if (settings.EdgeLength != 0.0)
  {
    const volumic::EdgeLengthPlan plan = volumic::PlanEdgeLength(
      settings.EdgeLength, settings.Options.SamplingRatio, image, request.Levels);
    settings.End.FinestLevel = plan.FinestLevel;
    settings.Options.SamplingRatio = plan.SamplingRatio;
    volume.FactorBelowLevel0 = plan.ReductionFactor;
    volume.EdgeLengthIsPlanned = true;
  }
  volume.LevelsAreOwn = true;
  volume.Levels =
    volumic::BuildPyramid(image, volume.Selection, settings.SelectedComponent, request);
}

//------------------------------------------------------------------------------
volumic::SegmentationVolume vtkDeformableSurface::PrepareVolume(vtkDataObject* input)
{
  volumic::SegmentationVolume volume = this->VolumeAsSet();
  volume.Levels = vtkMultiBlockDataSet::SafeDownCast(input);
  if (BuildsPyramid(input))
  {
    const vtkSmartPointer<vtkDataObject> read = this->ReadInput(input, false, volume);
    if (read)
    {
      vtkImageData* image =
        volumic::PrefixErrors("Input port 0: ", [&] { return volumic::ImageOf(read); });
      this->MakeLevels({}, image, volume);
    }
    return volume;
  }
  volumic::PyramidRequest request = this->PyramidAsSet();
  vtkImageData* image = volume.Levels->GetNumberOfBlocks() > 0
    ? vtkImageData::SafeDownCast(volume.Levels->GetBlock(0))
    : nullptr;
  // Means of folded voxels are not the folded means. What is no image the run refuses.
  if (image && request.Range.IsUsed())
  {
    request.Levels = volumic::LevelsAs(volume.Levels);
    volume.Levels = volumic::BuildPyramid(image, volume.Selection, -1, request);
  }
  return volume;
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::ShowPyramidProgress(double share, const char* text)
{
  return this->Internals->All->GoOn(PyramidShare * share, text) &&
    !this->Internals->Limit.IsOver();
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::vtkInternals::IsStopped()
{
  return volumic::IsAbortRequested(&this->Filter) || this->All->IsStoppedByOthers();
}

//------------------------------------------------------------------------------
volumic::SegmentationRequest vtkDeformableSurface::vtkInternals::RequestAsSet(
  const volumic::FilterCall& call)
{
  volumic::SegmentationRequest request;
  request.Started = volumic::Deadline::Clock::now();
  request.End = this->Settings.End;
  request.End.FinestLevel = this->Settings.LastLevel();
  const double limit = request.End.TimeLimit;
  if (!(limit >= 0.0))
  {
    volumic::Refuse("Time Limit is ", limit, "; it must be 0 (none) or more.");
  }
  request.Limit = volumic::Deadline(request.Started, limit);
  this->Limit = request.Limit;
  this->InitialSurface = this->All->TakePoints(1);
  this->AttractingPoints = this->All->TakePoints(2);
  request.InitialSurface = this->InitialSurface;
  request.AttractingPoints = this->AttractingPoints;
  request.EdgeSelection = this->Filter.GetInputArrayInformation(1);
  request.Checkpoints.AreLeft = request.End.LeavesCheckpoints();
  request.MayGoOn = volumic::SegmentationCache::MayKeep(&this->Filter);
  // Whoever watches may choose others; else, and where memory is short, it would be held in vain.
  request.KeepsAll = this->IsWatched && !request.Checkpoints.AreLeft;
  request.Checkpoints.Directory = request.End.ScratchDirectory;
  request.Checkpoints.Resumes = request.End.Resume;
  request.Checkpoints.Stay = this->LeavesCheckpoints;
  request.Checkpoints.Prepared = [this](const auto& checkpoint)
  { this->Checkpoint = checkpoint; };
  const double before = BuildsPyramid(vtkDataObject::GetData(call.Inputs[0])) ? PyramidShare : 0.0;
  request.Progress = [this, before](double share, const std::string& text)
  { return this->All->GoOn(before + (1.0 - before) * share, text); };
  request.Warn = [this](const std::string& text) { this->Filter.Warn(text); };
  return request;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::ChooseStep(
  volumic::SegmentationRequest& request, bool isKept)
{
  const volumic::SegmentationSettings& settings = this->Settings;
  // Whoever asks whether a finer level is still to come asks one rank only: the others would not
  // run again.
  const bool isWatched =
    settings.End.ShowLevels && this->IsWatched && !this->All->AreMany();
  if (!isWatched || std::exchange(this->GoesToTheEnd, false))
  {
    return;
  }
  const volumic::SegmentationCache& cache = this->Cache;
  if (!isKept || !cache.CanGoOn())
  {
    request.End.Preview = true;
    request.IsStep = !settings.End.Preview;
    return;
  }
  const int next = cache.NextLevel();
  if (settings.End.Preview || settings.EdgeLength != 0.0 || settings.Grading.IsWanted() ||
    next <= std::max(settings.End.FinestLevel, 0))
  {
    return;
  }
  request.End.FinestLevel = next;
  request.IsStep = true;
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::vtkInternals::ShowKept(
  const volumic::SegmentationRequest& request, vtkInformationVector* output)
{
  volumic::SegmentationCache& cache = this->Cache;
  const volumic::SegmentationResults* results = cache.ResultsFor(this->Settings, request);
  if (!results)
  {
    return false;
  }
  const int end = cache.EndOf(request.End);
  results->FillOutputs(end, output);
  results->WarnOf(end, this->Settings.WantsAllParts(), request.Warn);
  return true;
}

//------------------------------------------------------------------------------
std::unique_ptr<volumic::SurfaceSegmentation> vtkDeformableSurface::vtkInternals::NewRun(
  const volumic::SegmentationRequest& request, const volumic::FilterCall& call)
{
  const vtkSmartPointer<vtkDataObject> input = volumic::PrefixErrors(
    "Input port 0: ", [&] { return this->All->TakeImages(0); });
  if (BuildsPyramid(input))
  {
    this->Filter.ShowPyramidProgress(0.0); // Whether to stop is asked when there is more to do.
  }
  const volumic::SegmentationVolume volume = this->Filter.PrepareVolume(input);
  if (!volume.Levels)
  {
    return nullptr;
  }
  auto run = std::make_unique<volumic::SurfaceSegmentation>(volume, request);
  if (!volume.LevelsAreOwn && volumic::AreReleased(&this->Filter, 0))
  {
    input->ReleaseData(); // Now: the run lets go of each level when it has left it.
  }
  return run;
}

//------------------------------------------------------------------------------
auto vtkDeformableSurface::vtkInternals::ChooseCourse(bool isKept,
  volumic::SegmentationRequest& request, std::unique_ptr<volumic::SurfaceSegmentation>& run,
  vtkInformationVector* output) -> Course
{
  volumic::SegmentationCache& cache = this->Cache;
  isKept = isKept && cache.GradesFor(request.End);
  if (isKept && this->ShowKept(request, output))
  {
    return Course::IsShown;
  }
  this->ChooseStep(request, isKept);
  run = isKept ? cache.TakeRun() : nullptr;
  cache.Drop();
  if (run)
  {
    run->Renew(request);
  }
  if (!run || !run->CanServe())
  {
    run.reset(); // Not the levels of both at a time.
  }
  return run ? Course::GoesOn : Course::BeginsAnew;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::RunOrGoOn(const volumic::FilterCall& call)
{
  const volumic::SegmentationSettings& settings = this->Settings;
  volumic::SegmentationCache& cache = this->Cache;
  bool isKept = cache.IsValidFor(&this->Filter, this->All->Count());
  // What has changed on one rank has changed for all.
  for (volumic::RankMessage& other : this->All->AskAll(volumic::RankQuestion::Own))
  {
    bool isKeptThere = false;
    other >> isKeptThere;
    isKept = isKept && isKeptThere;
  }
  volumic::SegmentationRequest request = this->RequestAsSet(call);
  this->IsOnTheWay = false;
  std::unique_ptr<volumic::SurfaceSegmentation> run;
  const Course course = this->ChooseCourse(isKept, request, run, call.Outputs);
  if (course == Course::IsShown)
  {
    return;
  }
  cache.Drop();
  this->Checkpoint.reset();
  if (course == Course::BeginsAnew)
  {
    run = this->NewRun(request, call);
  }
  if (!run)
  {
    const bool isAborted = this->IsStopped() || !request.Limit.IsOver();
    FillByNothing(call.Outputs, isAborted, settings.Profile);
    return;
  }
  run->Run();
  this->ShowRun(*run, request, call.Outputs);
  cache.Keep(std::move(run), &this->Filter, this->All->Count());
  volumic::GiveBackFreeMemory();
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::ShowRun(const volumic::SurfaceSegmentation& run,
  const volumic::SegmentationRequest& request, vtkInformationVector* output)
{
  const volumic::SegmentationSettings& settings = this->Settings;
  run.Results().FillOutputs(run.EndsAt(), output);
  const bool isCutOff = request.Limit.IsOver() || this->IsStopped();
  const bool isFinest =
    run.EndsAt() <= settings.LastLevel() && settings.EdgeLength == 0.0;
  if (request.IsStep && isFinest)
  {
    run.Results().WarnOf(run.EndsAt(), settings.WantsAllParts(), request.Warn);
  }
  this->IsOnTheWay = request.IsStep && !isCutOff && !isFinest;
}
