// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/ReadVolume.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/Errors.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/ValueHints.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>

#include <cmath>

namespace volumic
{
namespace
{
LevelsOptions MakeLevelsOptions(const SegmentationSettings& settings)
{
  LevelsOptions options;
  options.Pyramid = settings.Pyramid;
  options.Range = settings.Range();
  options.NaNIsBackground = settings.NaNIsBackground;
  options.NumberOfThreads = settings.End.NumberOfThreads;
  return options;
}

/** Convert cell data to point data, and compute the iso-value if it is not set. */
vtkSmartPointer<vtkImageData> CompleteImage(
  SegmentationRequest& request, vtkImageData* image, Volume& volume)
{
  SegmentationSettings& settings = request.Settings;
  const PointVoxels voxels = ConvertCellsToPoints(image, request.Selection);
  request.Selection = voxels.Selection;
  if (std::isnan(settings.Options.IsoValue))
  {
    settings.Options.IsoValue =
      PrefixErrors("Iso Value is not set, and cannot be computed: Input port 0: ",
        [&]
        {
          return FindOtsuThreshold(voxels.Image, voxels.Selection, settings.SelectedComponent)
            .Threshold;
        });
  }
  vtkDataArray* values =
    PrefixErrors(VoxelErrorPrefix, [&] { return ChooseArray(voxels.Selection, voxels.Image); });
  if (values->GetNumberOfComponents() == 1 && values->HasStandardMemoryLayout())
  {
    volume.HintAtLabels = HintAtLabels(values, voxels.Image->GetDimensions());
  }
  return voxels.Image;
}

void ReadImage(Volume& volume, SegmentationRequest& request, const Progress& progress)
{
  SegmentationSettings& settings = request.Settings;
  vtkSmartPointer<vtkImageData> image =
    PrefixErrors(VoxelErrorPrefix, [&] { return ImageOf(request.Volume); });
  if (settings.OfImages)
  {
    image = CompleteImage(request, image, volume);
  }
  LevelsOptions options = MakeLevelsOptions(settings);
  double factorBelow = volume.Voxels.FactorBelow;
  if (settings.EdgeLength != 0.0)
  {
    const EdgeLengthPlan plan =
      PlanEdgeLength(settings.EdgeLength, settings.Options.SamplingRatio, image, options.Pyramid);
    settings.End.FinestLevel = plan.FinestLevel;
    settings.Options.SamplingRatio = plan.SamplingRatio;
    factorBelow = plan.ReductionFactor;
  }
  volume.IsOfImage = true;
  volume.Voxels = PrefixErrors(VoxelErrorPrefix,
    [&]
    {
      vtkDataArray* array = ChooseArray(request.Selection, image);
      return MakeImageLevels(
        image, SelectComponent(array, settings.SelectedComponent), options, progress);
    });
  volume.Voxels.FactorBelow = factorBelow;
}

ImageLevels ReadBlocks(const SegmentationRequest& request, const Progress& progress)
{
  const SegmentationSettings& settings = request.Settings;
  ImageLevels levels = LevelsOfBlocks(vtkMultiBlockDataSet::SafeDownCast(request.Volume),
    request.Selection, settings.NaNIsBackground);
  // FoldVoxels() does not commute with the means of coarser levels.
  if (settings.Range().IsUsed())
  {
    LevelsOptions options = MakeLevelsOptions(settings);
    options.Pyramid = levels.Options();
    levels = MakeImageLevels(levels.Levels[0].Image, levels.Levels[0].Voxels, options, progress);
    levels.NaNWarning.clear(); // Image Pyramid has reported it.
  }
  return levels;
}

void ReadEdges(Volume& volume, const SegmentationRequest& request, const Progress& progress)
{
  vtkInformation* selection = request.EdgeSelection;
  const bool isChosen = selection &&
    (selection->Has(vtkDataObject::FIELD_NAME()) ||
      selection->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()));
  if (!isChosen)
  {
    ThrowInvalidArgument(
      "Edge Attraction Weight is not 0, but there is no edge map. Choose a second point array of "
      "the "
      "image as Edge Map (SetInputArrayToProcess(1, ...)), such as its gradient magnitude.");
  }
  PrefixErrors(EdgeErrorPrefix,
    [&]
    {
      volume.Edges = LevelsOfArray(volume.Voxels, selection, request.Settings.End.NumberOfThreads,
        [&progress](double, const std::string& text) { return progress(1.0, text); });
    });
}
}

Volume ReadVolume(SegmentationRequest& request, const Progress& progress)
{
  request.Settings.Range(); // Check the range before reading.
  Volume volume;
  if (vtkMultiBlockDataSet::SafeDownCast(request.Volume) && !request.Settings.OfImages)
  {
    volume.Voxels = PrefixErrors(VoxelErrorPrefix, [&] { return ReadBlocks(request, progress); });
  }
  else
  {
    ReadImage(volume, request, progress);
  }
  if (request.Settings.Options.EdgeAttractionWeight > 0.0 && volume.Voxels.IsComplete)
  {
    ReadEdges(volume, request, progress);
  }
  return volume;
}
}
