// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RunLevels.h"

#include "Host/Errors.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/SlabInput.h"
#include "Input/ValueHints.h"
#include "Pyramid/PyramidBlocks.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>

#include <cmath>

namespace volumic
{
namespace
{
constexpr const char* Port0 = "Input port 0: ";
/** Share of the work that the reading takes where the image comes in slabs. */
constexpr double ReadingShare = 0.5;

/** The data of input port 0, whole. Null after a stop. */
vtkSmartPointer<vtkDataObject> ReadInput(
  SegmentationRequest& request, vtkDataObject* input, const VoxelSource& source)
{
  if (source.MemoryLimit == 0)
  {
    return input;
  }
  const SlabInput slabs(source.Filter);
  SlabInput::Request wanted;
  wanted.Limit = source.MemoryLimit;
  wanted.Selection = request.Selection;
  wanted.SelectedComponent = request.Settings.SelectedComponent;
  wanted.TakesCells = request.Settings.OfImages;
  wanted.GoOn = [&source](double share)
  { return source.GoOn(ReadingShare * share, "Reading the image"); };
  const SlabInput::Result read = PrefixErrors(Port0, [&] { return slabs.Read(wanted); });
  source.WarnOnce("whole", slabs.DescribeWhole());
  if (read.IsStopped || !read.Image)
  {
    return read.IsStopped ? nullptr : input;
  }
  request.Selection = read.Selection;
  request.Settings.SelectedComponent = -1; // It has been selected.
  return read.Image;
}

PyramidRequest PyramidAsSet(const SegmentationSettings& settings, const VoxelSource& source)
{
  PyramidRequest pyramid;
  pyramid.Levels = settings.Pyramid;
  pyramid.Range = settings.Range();
  pyramid.NaNIsBackground = settings.NaNIsBackground;
  pyramid.NumberOfThreads = settings.End.NumberOfThreads;
  pyramid.Progress = [&source](double share, const std::string&)
  { return source.GoOn(share, "Building the pyramid"); };
  return pyramid;
}

/** Takes cells as points, and finds an iso-value that is not set. */
vtkSmartPointer<vtkImageData> CompleteImage(
  SegmentationRequest& request, vtkImageData* image, const VoxelSource& source)
{
  SegmentationSettings& settings = request.Settings;
  const PointVoxels voxels = TakeCellsAsPoints(image, request.Selection);
  request.Selection = voxels.Selection;
  if (std::isnan(settings.Options.IsoValue))
  {
    settings.Options.IsoValue =
      PrefixErrors("Iso Value is not set, and can't be found: Input port 0: ",
        [&]
        {
          return FindOtsuThreshold(voxels.Image, voxels.Selection, settings.SelectedComponent,
            settings.End.NumberOfThreads)
            .Threshold;
        });
  }
  vtkDataArray* values =
    PrefixErrors(Port0, [&] { return ChooseArray(voxels.Selection, voxels.Image); });
  if (values->GetNumberOfComponents() == 1 && values->HasStandardMemoryLayout())
  {
    source.WarnOnce("labels", HintAtLabels(values, voxels.Image->GetDimensions()));
  }
  return voxels.Image;
}

void MakeLevels(SegmentationRequest& request, vtkImageData* image, const VoxelSource& source)
{
  SegmentationSettings& settings = request.Settings;
  PyramidRequest pyramid = PyramidAsSet(settings, source);
  if (settings.EdgeLength != 0.0)
  {
    const EdgeLengthPlan plan =
      PlanEdgeLength(settings.EdgeLength, settings.Options.SamplingRatio, image, pyramid.Levels);
    settings.End.FinestLevel = plan.FinestLevel;
    settings.Options.SamplingRatio = plan.SamplingRatio;
    request.FactorBelowLevel0 = plan.ReductionFactor;
  }
  request.LevelsAreOwn = true;
  request.Levels = BuildPyramid(image, request.Selection, settings.SelectedComponent, pyramid);
}
}

bool IsImage(vtkDataObject* input)
{
  return vtkMultiBlockDataSet::SafeDownCast(input) == nullptr;
}

void SetLevels(SegmentationRequest& request, vtkDataObject* input, const VoxelSource& source)
{
  SegmentationSettings& settings = request.Settings;
  const ValueRange range = settings.Range(); // Refused before anything is read.
  if (IsImage(input) || settings.OfImages)
  {
    const vtkSmartPointer<vtkDataObject> read = ReadInput(request, input, source);
    if (read)
    {
      vtkSmartPointer<vtkImageData> image = PrefixErrors(Port0, [&] { return ImageOf(read); });
      if (settings.OfImages)
      {
        image = CompleteImage(request, image, source);
      }
      MakeLevels(request, image, source);
    }
    return;
  }
  request.Levels = vtkMultiBlockDataSet::SafeDownCast(input);
  vtkImageData* image = request.Levels->GetNumberOfBlocks() > 0
    ? vtkImageData::SafeDownCast(request.Levels->GetBlock(0))
    : nullptr;
  // Means of folded voxels are not the folded means. What is no image the run refuses.
  if (image && range.IsUsed())
  {
    PyramidRequest pyramid = PyramidAsSet(settings, source);
    pyramid.Levels = LevelsAs(request.Levels);
    request.Levels = BuildPyramid(image, request.Selection, -1, pyramid);
  }
}
}
