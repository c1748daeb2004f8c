// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationLevels.h"

#include "Core/Common/Refuse.h"
#include "Core/Image/ThickPart.h"
#include "Host/Errors.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/InputPoints.h"
#include "Input/ValueHints.h"
#include "Pyramid/PyramidBlocks.h"
#include "Pyramid/PyramidLevels.h"
#include "Settings/SegmentationSettings.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace volumic
{
namespace
{
constexpr const char* Port0 = "Input port 0: ";
constexpr const char* PlaceOfEdges = "Input port 0, the map of edges: ";

/** Image Pyramid has counted them, and tells it itself where it is a filter of the user's. */
bool MayHaveNaNsToReport(const SegmentationRequest& request)
{
  vtkDataArray* counted = request.Levels->GetFieldData()->GetArray("NaNVoxels");
  return !counted || (request.LevelsAreOwn && counted->GetTuple1(0) > 0.0);
}

PyramidLevels ReadVoxels(const SegmentationRequest& request)
{
  const SegmentationSettings& settings = request.Settings;
  CheckEnumeration("Metric", settings.Metric, Metric::World);
  return PrefixErrors(Port0,
    [&]
    {
      return PyramidLevels(
        request.Levels, request.Selection, settings.Metric, settings.NaNIsBackground);
    });
}

/** The blocks where all of them carry the map, else the pyramid of block 0's; null after a stop. */
vtkSmartPointer<vtkMultiBlockDataSet> LevelsOfMap(const SegmentationRequest& request)
{
  vtkMultiBlockDataSet* blocks = request.Levels;
  vtkInformation* selection = request.EdgeSelection;
  auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(0));
  ChooseVoxels(selection, image);
  const std::string name = ChosenName(selection);
  bool everywhere = !name.empty();
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    auto* level = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    everywhere = everywhere && level && level->GetPointData()->HasArray(name.c_str());
  }
  if (everywhere || blocks->GetNumberOfBlocks() <= 1)
  {
    return blocks;
  }
  PyramidRequest pyramid;
  pyramid.Levels = LevelsAs(blocks);
  pyramid.NumberOfThreads = request.Settings.End.NumberOfThreads;
  pyramid.Progress = [&request](double, const std::string&)
  { return request.Progress(0.0, "Pyramid of the map of edges") && !request.Limit.IsOver(); };
  return BuildPyramid(image, selection, -1, pyramid);
}

/** The levels of the map of edges; null after a stop. */
std::unique_ptr<PyramidLevels> ReadEdges(const SegmentationRequest& request)
{
  vtkInformation* selection = request.EdgeSelection;
  const bool isChosen = selection &&
    (selection->Has(vtkDataObject::FIELD_NAME()) ||
      selection->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()));
  if (!isChosen)
  {
    Refuse("Edge Attraction Weight is not 0, but there is no map of edges: choose a second point "
           "array of the image as Edge Map (SetInputArrayToProcess(1, ...)), such as its gradient "
           "magnitude.");
  }
  return PrefixErrors(PlaceOfEdges,
    [&]
    {
      const vtkSmartPointer<vtkMultiBlockDataSet> levels = LevelsOfMap(request);
      return levels ? std::make_unique<PyramidLevels>(levels, selection, Metric::Voxels) : nullptr;
    });
}

/** What voxels get that are not valid: as far from the iso-value as any voxel is (Field.h). */
double BackgroundOf(const std::array<double, 2>& range, const SurfaceOptions& options)
{
  const double iso = options.IsoValue;
  const double away = std::max(range[1] - iso, iso - range[0]);
  return options.ObjectIsBright ? iso - away : iso + away;
}
}

SegmentationLevels::SegmentationLevels(const SegmentationRequest& request)
  : MayHaveUnreportedNaNs(MayHaveNaNsToReport(request)), Voxels(ReadVoxels(request))
{
  this->Voxels.SetFactorBelowLevel0(request.FactorBelowLevel0);
}

SegmentationLevels::~SegmentationLevels() = default;

void SegmentationLevels::ReadAttraction(const SegmentationRequest& request)
{
  const SegmentationSettings& settings = request.Settings;
  const SurfaceOptions& options = settings.Options;
  std::vector<AttractingPoint> points = PrefixErrors("Input port 2 (Attracting Points): ",
    [&]
    {
      return AttractingPointsOf(
        request.AttractingPoints, this->GetWorkspace(), this->Voxels.SizeOfLevel0());
    });
  for (const Point& place : PositionsOf(settings.AttractingPositions, "Attracting Positions",
         this->GetWorkspace(), this->Voxels.SizeOfLevel0()))
  {
    points.emplace_back();
    points.back().Place = place;
  }
  if (!points.empty() && options.PointAttractionWeight > 0.0)
  {
    this->Points =
      std::make_unique<PointAttraction>(std::move(points), options.PointAttractionWeight);
  }
  this->Edges = options.EdgeAttractionWeight > 0.0 ? ReadEdges(request) : nullptr;
}

std::array<double, 2> SegmentationLevels::Range(int level) const
{
  return PrefixErrors(Port0, [&] { return this->Voxels.Range(level); });
}

bool SegmentationLevels::HoldsObject(int level, const SurfaceOptions& options) const
{
  const auto found = this->Holds.find(level);
  if (found != this->Holds.end())
  {
    return found->second;
  }
  const PartSize least =
    options.RecoverLostParts ? PartSize{ options.MinimumPartSize, 1 } : PartThatHolds;
  return this->Holds[level] =
           this->Voxels.HoldsPart(level, least, options.IsoValue, options.ObjectIsBright);
}

std::string SegmentationLevels::DescribeUnreportedNaNs() const
{
  const std::string text =
    this->MayHaveUnreportedNaNs ? this->Voxels.DescribeNaNsOfLevel0() : std::string();
  return text.empty() ? text : Port0 + text;
}

LevelImage SegmentationLevels::Load(int level, const SurfaceOptions& options, Executor& threads)
{
  const double background = BackgroundOf(this->Range(std::max(level, 0)), options);
  LevelImage image = PrefixErrors(
    Port0, [&] { return this->Voxels.Load(level, options.IsoValue, background, threads); });
  if (this->Edges)
  {
    image.Edges = this->LoadEdges(level, image.Size, threads);
  }
  if (this->Points)
  {
    this->Bent = this->Points->Bend(image, options, threads);
    image.Values = this->Bent.data();
  }
  return image;
}

VoxelValues SegmentationLevels::LoadEdges(
  int level, const std::array<int, 3>& size, Executor& threads)
{
  return PrefixErrors(PlaceOfEdges,
    [&]
    {
      // The force knows differences only.
      const double lowest = this->Edges->Range(0)[0];
      const LevelImage loaded = level < this->Edges->NumberOfLevels()
        ? this->Edges->Load(level, lowest, lowest, threads)
        : LevelImage();
      if (loaded.Size != size)
      {
        Refuse("its level ", level, " has ", loaded.Size[0], " x ", loaded.Size[1], " x ",
          loaded.Size[2], " voxels, that of the voxels ", size[0], " x ", size[1], " x ", size[2],
          ". Give the image instead of its pyramid, or one whose blocks all carry both arrays.");
      }
      return loaded.Values;
    });
}

void SegmentationLevels::ReleaseCoarserThan(int level)
{
  this->Voxels.ReleaseCoarserThan(level);
  if (this->Edges)
  {
    this->Edges->ReleaseCoarserThan(level);
  }
  this->Bent = std::vector<float>();
}

namespace
{
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
    vtkSmartPointer<vtkImageData> image = PrefixErrors(Port0, [&] { return ImageOf(input); });
    if (settings.OfImages)
    {
      image = CompleteImage(request, image, source);
    }
    MakeLevels(request, image, source);
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
