// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BuildPyramid.h"

#include "AlgorithmErrors.h"
#include "Core/Refuse.h"
#include "vtkImagePyramid.h"

#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>

#include <stdexcept>

namespace volumic
{
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

vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImagePyramid* pyramid, vtkImageData* image, vtkInformation* selection)
{
  pyramid->SetInputData(image);
  pyramid->SetInputArrayToProcess(0, selection);
  const std::string errors = UpdateAndCollectErrors(pyramid);
  if (!errors.empty() && pyramid->GetErrorCode() == vtkErrorCode::UnknownError)
  {
    throw std::runtime_error(errors);
  }
  if (!errors.empty())
  {
    Refuse(errors);
  }
  return pyramid->GetOutput();
}
}
