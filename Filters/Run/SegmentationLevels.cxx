// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationLevels.h"

#include "Core/Image/ThickPart.h"
#include "Host/PrefixErrors.h"
#include "Input/InputPoints.h"
#include "Pyramid/FieldVoxels.h"
#include "Settings/CheckEnumeration.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>

#include <algorithm>
#include <utility>

namespace volumic
{
namespace
{
constexpr const char* Port0 = "Input port 0: ";

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
}

SegmentationLevels::SegmentationLevels(const SegmentationRequest& request)
  : MayHaveUnreportedNaNs(MayHaveNaNsToReport(request)), Voxels(ReadVoxels(request))
{
  this->Voxels.SetFactorBelowLevel0(request.FactorBelowLevel0);
}

SegmentationLevels::~SegmentationLevels() = default;

std::vector<Point> SegmentationLevels::SeedPositions(const SegmentationSettings& settings) const
{
  return PositionsOf(settings.End.SeedPositions, "Seed Positions", this->GetWorkspace(),
    this->Voxels.SizeOfLevel0());
}

std::vector<Point> SegmentationLevels::AttractingPositions(
  const SegmentationSettings& settings) const
{
  return PositionsOf(settings.AttractingPositions, "Attracting Positions", this->GetWorkspace(),
    this->Voxels.SizeOfLevel0());
}

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
  for (const Point& place : this->AttractingPositions(settings))
  {
    points.emplace_back();
    points.back().Place = place;
  }
  if (!points.empty() && options.PointAttractionWeight > 0.0)
  {
    this->Points =
      std::make_unique<PointAttraction>(std::move(points), options.PointAttractionWeight);
  }
  if (options.EdgeAttractionWeight > 0.0)
  {
    this->Edges = std::make_unique<EdgeLevels>(request.Levels, request.EdgeSelection,
      settings.End.NumberOfThreads,
      [&request](double) {
        return request.Progress(0.0, "Pyramid of the map of edges") && !request.Limit.IsOver();
      });
  }
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
  LevelImage image = PrefixErrors(Port0,
    [&] { return this->Voxels.Load(level, options.IsoValue, background, threads); });
  if (this->Edges)
  {
    image.Edges = this->Edges->Load(level, image.Size, threads);
  }
  if (this->Points)
  {
    this->Bent = this->Points->Bend(image, options, threads);
    image.Values = this->Bent.data();
  }
  return image;
}

std::uint64_t SegmentationLevels::HashOfEdges(Executor& threads) const
{
  return this->Edges ? this->Edges->HashOfVoxels(threads) : 0;
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
}
