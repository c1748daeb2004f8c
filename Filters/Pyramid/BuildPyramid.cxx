// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/BuildPyramid.h"

#include "Host/PrefixErrors.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>

#include <cmath>
#include <string>

namespace volumic
{
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, PyramidOptions& pyramid)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  const EdgeLengthPlan plan = PlanEdgeLength(edgeLength, { size[0], size[1], size[2] },
    { spacing[0], spacing[1], spacing[2] }, EdgeLengthPreferences{ pyramid, samplingRatio });
  pyramid.ReductionFactor = plan.ReductionFactor;
  return plan;
}

vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(vtkImageData* image,
  vtkInformation* selection, int component, const PyramidRequest& request)
{
  return PrefixErrors("Input port 0: ",
    [&]
    {
      bool isStopped = false;
      PyramidRequest watched = request;
      watched.Progress = [&](double share, const std::string& text)
      {
        isStopped = isStopped || !request.Progress(share, text);
        return !isStopped;
      };
      const PyramidBlocks made =
        MakePyramidBlocks(image, SelectComponent(ChooseArray(selection, image), component), watched);
      return isStopped ? nullptr : made.Blocks;
    });
}

PyramidOptions LevelsAs(vtkMultiBlockDataSet* blocks)
{
  const auto unit = [blocks](unsigned int h)
  {
    auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    vtkDataArray* array = image ? image->GetFieldData()->GetArray("Unit") : nullptr;
    return array && array->GetNumberOfTuples() == 1 ? array->GetTuple1(0) : 0.0;
  };
  const double factor = blocks->GetNumberOfBlocks() > 1 ? unit(1) / unit(0) : 0.0;
  PyramidOptions levels;
  levels.NumberOfLevels = static_cast<int>(blocks->GetNumberOfBlocks());
  levels.ReductionFactor = factor > 1.0 && factor < 2.0 ? factor : std::sqrt(3.0);
  return levels;
}
}
