// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What vtkDeformableSurface does at RequestData(): what is asked for, whether it is kept, whether
// the last run goes on or another one begins.

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Refuse.h"
#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Output/SurfaceOutput.h"
#include "Run/SegmentationLevels.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace
{
/** Share of the progress that the pyramid takes where it is built here. */
constexpr double PyramidShare = 0.02;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::Warn(const std::string& text)
{
  if (!text.empty() &&
    std::find(this->Warnings.begin(), this->Warnings.end(), text) == this->Warnings.end())
  {
    this->Warnings.push_back(text);
  }
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::vtkInternals::ShowProgress(double share, const std::string& text)
{
  this->Filter.SetProgressText(text.c_str());
  this->Filter.UpdateProgress(share);
  return !volumic::IsAbortRequested(&this->Filter);
}

//------------------------------------------------------------------------------
volumic::SegmentationRequest vtkDeformableSurface::vtkInternals::RequestAsSet(
  vtkInformationVector** inputs)
{
  volumic::SegmentationRequest request;
  request.Settings = this->Settings;
  volumic::SegmentationEnd& end = request.Settings.End;
  end.FinestLevel = this->Settings.LastLevel();
  if (!(end.TimeLimit >= 0.0))
  {
    volumic::Refuse("Time Limit is ", end.TimeLimit, "; it must be 0 (none) or more.");
  }
  request.Limit = volumic::Deadline(request.Started, end.TimeLimit);
  request.Selection = this->Filter.GetInputArrayInformation(0);
  request.InitialSurface = vtkPolyData::GetData(inputs[1]);
  request.AttractingPoints = vtkPolyData::GetData(inputs[2]);
  request.EdgeSelection = this->Filter.GetInputArrayInformation(1);
  request.MayGoOn = volumic::SegmentationCache::MayKeep(&this->Filter);
  // Whoever watches may choose others; else it would be held in vain.
  request.KeepsAll = this->IsWatched;
  const bool makesLevels = volumic::IsImage(vtkDataObject::GetData(inputs[0]));
  request.Progress = [this, before = makesLevels ? PyramidShare : 0.0](
                       double share, const std::string& text)
  { return this->ShowProgress(before + (1.0 - before) * share, text); };
  request.Warn = [this](const std::string& text) { this->Warn(text); };
  return request;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::ChooseStep(
  volumic::SegmentationRequest& request, const volumic::SurfaceSegmentation* kept)
{
  const volumic::SegmentationSettings& settings = this->Settings;
  // GetNeedsUpdate() is called in one process only: the others would not update again.
  const bool isWatched = settings.End.ShowLevels && this->IsWatched && this->IsOnlyProcess;
  if (!isWatched || std::exchange(this->GoesToTheEnd, false))
  {
    return;
  }
  if (!kept || !kept->CanGoOn())
  {
    request.Settings.End.Preview = true;
    request.IsStep = !settings.End.Preview;
    return;
  }
  const int next = kept->NextLevel();
  if (settings.End.Preview || settings.EdgeLength != 0.0 || settings.Grading.IsWanted() ||
    next <= std::max(settings.End.FinestLevel, 0))
  {
    return;
  }
  request.Settings.End.FinestLevel = next;
  request.IsStep = true;
}

//------------------------------------------------------------------------------
std::unique_ptr<volumic::SurfaceSegmentation> vtkDeformableSurface::vtkInternals::NewRun(
  volumic::SegmentationRequest request, vtkInformationVector* inputVector)
{
  vtkDataObject* input =
    volumic::PrefixErrors("Input port 0: ", [&] { return volumic::WholeInput(inputVector); });
  volumic::VoxelSource source;
  source.GoOn = [&](double share, const char* text)
  { return this->ShowProgress(PyramidShare * share, text) && !request.Limit.IsOver(); };
  source.WarnOnce = [this](const char* what, const std::string& text)
  {
    if (!text.empty() && this->WarnedOf.insert(what).second)
    {
      this->Warn("Input port 0: " + text);
    }
  };
  if (volumic::IsImage(input))
  {
    source.GoOn(0.0, "Building the pyramid"); // Whether to stop is asked when there is more to do.
  }
  volumic::SetLevels(request, input, source);
  if (!request.Levels)
  {
    return nullptr;
  }
  auto run = std::make_unique<volumic::SurfaceSegmentation>(request);
  if (!request.LevelsAreOwn && volumic::AreReleased(&this->Filter, 0))
  {
    input->ReleaseData(); // Now: the run lets go of each level when it has left it.
  }
  return run;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::RunOrGoOn(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const volumic::SegmentationSettings& settings = this->Settings;
  volumic::SegmentationRequest request = this->RequestAsSet(inputs);
  this->IsOnTheWay = false;
  volumic::SurfaceSegmentation* kept =
    this->Cache.IsValidFor(&this->Filter) ? this->Cache.Run() : nullptr;
  kept = kept && kept->GradesFor(request) ? kept : nullptr;
  if (kept && kept->HasAll(request))
  {
    kept->Results().FillOutputs(kept->EndOf(request), outputs);
    request.Warn(kept->Results().WarningOf(kept->EndOf(request), settings.WantsAllParts()));
    return;
  }
  this->ChooseStep(request, kept);
  std::unique_ptr<volumic::SurfaceSegmentation> run = this->Cache.TakeRun();
  if (!kept || !kept->CanGoOn() || !kept->Renew(request))
  {
    run.reset(); // Not the levels of both at a time.
    run = this->NewRun(request, inputs[0]);
  }
  const auto isStopped = [this] { return volumic::IsAbortRequested(&this->Filter); };
  if (!run)
  {
    const bool isLate = request.Limit.IsOver() && !isStopped();
    volumic::SegmentationResults nothing(settings.Profile);
    nothing.SetStoppedSurface(volumic::MakeStopped(
      0, isLate ? volumic::TimeLimitReason : Describe(volumic::StopReason::Cancelled)));
    nothing.FillOutputs(0, outputs);
    return;
  }
  run->Run();
  run->Results().FillOutputs(run->EndsAt(), outputs);
  const bool isFinest = run->EndsAt() <= settings.LastLevel() && settings.EdgeLength == 0.0;
  if (request.IsStep && isFinest)
  {
    request.Warn(run->Results().WarningOf(run->EndsAt(), settings.WantsAllParts()));
  }
  this->IsOnTheWay = request.IsStep && !request.Limit.IsOver() && !isStopped() && !isFinest;
  this->Cache.Keep(std::move(run), &this->Filter);
  volumic::GiveBackFreeMemory();
}
