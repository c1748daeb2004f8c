// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The work of vtkDeformableSurface::RequestData(): make the request, then reuse, resume or replace
// the kept run.

#include "Core/Common/FreeMemory.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/PyramidGeometry.h"
#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Pyramid/ImageLevels.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace
{
/** Fraction of the progress for the pyramid, if the input is an image. */
constexpr double PyramidFraction = 0.02;

bool IsImage(const volumic::SegmentationRequest& request)
{
  return vtkMultiBlockDataSet::SafeDownCast(request.Volume) == nullptr;
}

/**
 * Return the extent and spacing of the image in the pipeline information, without voxels.
 * @param areCells whether the voxels are the cells
 */
vtkSmartPointer<vtkImageData> ImageGeometry(vtkInformation* info, bool areCells)
{
  std::array<int, 6> extent;
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
  for (std::size_t last = 1; areCells && last < extent.size(); last += 2)
  {
    extent[last] = std::max(extent[last - 1], extent[last] - 1);
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(extent.data());
  if (info->Has(vtkDataObject::SPACING()))
  {
    image->SetSpacing(info->Get(vtkDataObject::SPACING()));
  }
  return image;
}
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::Modify(bool needsRun)
{
  const vtkMTimeType before = this->Filter.GetMTime();
  this->Filter.Modified();
  if (!needsRun && this->TimeOfKept == before)
  {
    this->TimeOfKept = this->Filter.GetMTime();
  }
}

//------------------------------------------------------------------------------
volumic::SegmentationRequest vtkDeformableSurface::vtkInternals::MakeRequest(
  vtkInformationVector** inputs)
{
  volumic::SegmentationRequest request;
  request.Settings = this->Settings;
  request.Settings.End.FinestLevel = this->Settings.LastLevel();
  request.Volume =
    volumic::PrefixErrors("Input port 0: ", [&] { return volumic::WholeInput(inputs[0]); });
  request.InitialSurface = vtkPolyData::GetData(inputs[1]);
  request.AttractingPoints = vtkPolyData::GetData(inputs[2]);
  request.Selection = this->Filter.GetInputArrayInformation(0);
  request.EdgeSelection = this->Filter.GetInputArrayInformation(1);
  request.MayResume = volumic::MayKeepRun(&this->Filter);
  // Only a user at a window selects other components later.
  request.KeepsAll = this->IsWatched && this->Settings.End.ScratchDirectory.empty();
  return request;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::ChooseStep(volumic::SegmentationRequest& request)
{
  volumic::SegmentationEnd& end = request.Settings.End;
  const bool isWatched = end.ShowLevels && this->IsWatched && this->IsAlone;
  if (!isWatched || std::exchange(this->RunsToTheEnd, false))
  {
    return;
  }
  if (!this->Kept || !this->Kept->CanResume())
  {
    request.IsStep = !end.Preview;
    end.Preview = true;
    return;
  }
  const int next = this->Kept->NextLevel();
  if (!end.Preview && request.Settings.EdgeLength == 0.0 &&
    !request.Settings.Grading.IsRequested() && next > std::max(end.FinestLevel, 0))
  {
    end.FinestLevel = next;
    request.IsStep = true;
  }
}

//------------------------------------------------------------------------------
std::unique_ptr<volumic::SegmentationRun> vtkDeformableSurface::vtkInternals::NewRun(
  volumic::SegmentationRequest request, volumic::RunObserver& observer)
{
  const auto progress = [&observer](double fraction, const std::string&)
  { return observer.ReportProgress(PyramidFraction * fraction, "Building the pyramid"); };
  if (IsImage(request))
  {
    progress(0.0, "");
  }
  const volumic::Volume volume = volumic::ReadVolume(request, progress);
  if (!volume.HintAtLabels.empty() && !std::exchange(this->HasHinted, true))
  {
    observer.Warn(volumic::VoxelErrorPrefix + volume.HintAtLabels);
  }
  if (!volume.IsComplete())
  {
    return nullptr;
  }
  auto run = std::make_unique<volumic::SegmentationRun>(request, volume);
  if (!volume.Voxels.NaNWarning.empty())
  {
    observer.Warn(volumic::VoxelErrorPrefix + volume.Voxels.NaNWarning);
  }
  if (!volume.IsOfImage && volumic::AreReleased(&this->Filter, 0))
  {
    request.Volume->ReleaseData(); // The run releases each level after use.
  }
  return run;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::MakeEmptyLevels(
  vtkInformationVector* input, vtkMultiBlockDataSet* levels) const
{
  vtkInformation* info = input->GetInformationObject(0);
  auto* blocks = vtkMultiBlockDataSet::GetData(info);
  int finest = this->Settings.LastLevel();
  int count = blocks ? static_cast<int>(blocks->GetNumberOfBlocks()) : 0;
  if (info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    vtkInformation* selection = this->Filter.GetInputArrayInformation(0);
    const bool areCells = this->Settings.OfImages &&
      selection->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    const vtkSmartPointer<vtkImageData> image = ImageGeometry(info, areCells);
    const int* size = image->GetDimensions();
    volumic::PyramidOptions pyramid = this->Settings.Pyramid;
    try
    {
      if (this->Settings.EdgeLength != 0.0)
      {
        finest = volumic::PlanEdgeLength(
          this->Settings.EdgeLength, this->Settings.Options.SamplingRatio, image, pyramid)
                   .FinestLevel;
      }
      count = static_cast<int>(
        volumic::PlanPyramid({ size[0], size[1], size[2] }, { 1.0, 1.0, 1.0 }, pyramid).size());
    }
    catch (const volumic::InvalidArgument&)
    {
      finest = count = 0; // The first process reports the error.
    }
  }
  volumic::MakeNullBlocks(
    levels, volumic::LevelNames(count, this->Settings.End.Preview ? 0 : finest));
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::vtkInternals::Update(
  vtkInformationVector** inputs, vtkInformationVector* outputs, volumic::RunObserver& observer)
{
  volumic::SegmentationRequest request = this->MakeRequest(inputs);
  const bool warnsOfMissing = request.Settings.WarnsOfMissingParts();
  this->IsBetweenLevels = false;
  if (this->TimeOfKept != this->Filter.GetMTime() ||
    this->InputsOfKept != volumic::InputTimesOf(&this->Filter) ||
    (this->Kept && !this->Kept->HasGradingOf(request)))
  {
    this->ForgetRun();
  }
  if (!this->Kept || !this->Kept->HasAll(request))
  {
    this->ChooseStep(request);
  }
  std::unique_ptr<volumic::SegmentationRun> run = std::move(this->Kept);
  if (!run || !run->Renew(request))
  {
    run.reset(); // Release its levels first.
    run = this->NewRun(request, observer);
  }
  if (!run)
  {
    volumic::FinishedLevels nothing;
    nothing.SetStopped(observer.StopReason());
    nothing.FillOutputs(0, outputs);
    return;
  }
  run->Run(observer, IsImage(request) ? PyramidFraction : 0.0);
  run->FillOutputs(outputs);
  const bool isFinest =
    run->EndsAt() <= this->Settings.LastLevel() && this->Settings.EdgeLength == 0.0;
  if (!request.IsStep || isFinest)
  {
    observer.Warn(run->Warning(warnsOfMissing));
  }
  this->IsBetweenLevels = request.IsStep && !isFinest && !observer.IsStopped();
  if (volumic::MayKeepRun(&this->Filter))
  {
    this->TimeOfKept = this->Filter.GetMTime();
    this->InputsOfKept = volumic::InputTimesOf(&this->Filter);
    if (!run->CanResume())
    {
      run->ReleaseRunData();
    }
    this->Kept = std::move(run);
  }
  volumic::GiveBackFreeMemory();
}
