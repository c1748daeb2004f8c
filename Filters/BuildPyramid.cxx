// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BuildPyramid.h"

#include "AlgorithmErrors.h"
#include "Core/Common/Refuse.h"
#include "ImageVoxels.h"
#include "PrefixErrors.h"
#include "PyramidBlocks.h"
#include "vtkImagePyramid.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

#include <stdexcept>
#include <string>

namespace volumic
{
namespace
{
/** Observes the progress of a pyramid, and aborts it. */
struct ProgressObserver
{
  const Checkpoint& GoOn;
  bool Stopped = false;

  static void OnProgress(vtkObject* pyramid, unsigned long, void* client, void* share)
  {
    auto* self = static_cast<ProgressObserver*>(client);
    self->Stopped = self->Stopped || !self->GoOn(*static_cast<double*>(share));
    if (self->Stopped)
    {
      static_cast<vtkImagePyramid*>(pyramid)->SetAbortExecute(1);
    }
  }
};
}

EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, vtkImagePyramid* pyramid)
{
  EdgeLengthPreferences preferences;
  preferences.Pyramid.ReductionFactor = pyramid->GetReductionFactor();
  preferences.Pyramid.NumberOfLevels = pyramid->GetNumberOfLevels();
  preferences.Pyramid.MinimumLevelSize = pyramid->GetMinimumLevelSize();
  preferences.SamplingRatio = samplingRatio;
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  const EdgeLengthPlan plan = PlanEdgeLength(edgeLength, { size[0], size[1], size[2] },
    { spacing[0], spacing[1], spacing[2] }, preferences);
  pyramid->SetReductionFactor(plan.ReductionFactor);
  return plan;
}

namespace
{
/** Not through the pipeline, which knows of no pieces where the data are given. */
vtkSmartPointer<vtkMultiBlockDataSet> BuildOnRanks(Communicator& ranks, vtkImagePyramid* pyramid,
  vtkImageData* image, vtkInformation* selection, const Checkpoint& goOn)
{
  vtkSmartPointer<vtkDataArray> voxels;
  if (image)
  {
    voxels = SelectComponent(ChooseArray(selection, image), pyramid->GetSelectedComponent());
  }
  const PyramidImage level0(ranks, image, voxels);
  bool isStopped = false;
  PyramidRequest request;
  request.Levels.ReductionFactor = pyramid->GetReductionFactor();
  request.Levels.NumberOfLevels = pyramid->GetNumberOfLevels();
  request.Levels.MinimumLevelSize = pyramid->GetMinimumLevelSize();
  request.NaNIsBackground = pyramid->GetNaNIsBackground();
  request.NumberOfThreads = pyramid->GetNumberOfThreads();
  request.Progress = [&](double share, const std::string&)
  {
    isStopped = isStopped || !goOn(share);
    return !isStopped;
  };
  const PyramidBlocks made = MakePyramidBlocks(ranks, level0, request);
  return ranks.IsAny(isStopped) ? nullptr : made.Blocks;
}
}

vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(Communicator& ranks, vtkImagePyramid* pyramid,
  vtkImageData* image, vtkInformation* selection, const Checkpoint& goOn)
{
  if (ranks.NumberOfRanks() > 1)
  {
    return PrefixErrors(
      "Input port 0: ", [&] { return BuildOnRanks(ranks, pyramid, image, selection, goOn); });
  }
  ProgressObserver client{ goOn };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&client);
  observer->SetCallback(&ProgressObserver::OnProgress);
  const unsigned long progressTag = pyramid->AddObserver(vtkCommand::ProgressEvent, observer);
  // Warnings are given by the filter that it works within.
  vtkNew<vtkCallbackCommand> ignore;
  const unsigned long warningTag = pyramid->AddObserver(vtkCommand::WarningEvent, ignore);
  pyramid->SetInputData(image);
  pyramid->SetInputArrayToProcess(0, selection);
  const std::string errors = UpdateAndCollectErrors(pyramid);
  pyramid->RemoveObserver(progressTag);
  pyramid->RemoveObserver(warningTag);
  if (!errors.empty() && pyramid->GetErrorCode() == vtkErrorCode::UnknownError)
  {
    throw std::runtime_error(errors);
  }
  if (!errors.empty())
  {
    Refuse(errors);
  }
  if (client.Stopped)
  {
    return nullptr;
  }
  return pyramid->GetOutput();
}
}
