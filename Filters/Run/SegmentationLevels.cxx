// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationLevels.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Image/Field.h"
#include "Core/Image/ThickPart.h"
#include "Host/Errors.h"
#include "Input/InputPoints.h"

#include <algorithm>
#include <utility>

namespace volumic
{
namespace
{
PyramidLevels LevelsOfVoxels(const SegmentationRequest& request, const Volume& volume)
{
  const SegmentationSettings& settings = request.Settings;
  CheckEnumeration("Metric", settings.Metric, Metric::World);
  return PrefixErrors(VoxelErrorPrefix,
    [&] { return PyramidLevels(volume.Voxels, settings.Metric, settings.NaNIsBackground); });
}

/** Return the value of invalid voxels: as far from the iso-value as any voxel is (Field.h). */
double BackgroundOf(const std::array<double, 2>& range, const SurfaceOptions& options)
{
  const double iso = options.IsoValue;
  const double away = std::max(range[1] - iso, iso - range[0]);
  return options.ObjectIsBright ? iso - away : iso + away;
}
}

SegmentationLevels::SegmentationLevels(const SegmentationRequest& request, const Volume& volume)
  : Voxels(LevelsOfVoxels(request, volume))
{
  this->ReadPoints(request);
  this->ReadSeeds(request);
  if (!volume.Edges.Levels.empty())
  {
    this->Edges = PrefixErrors(EdgeErrorPrefix,
      [&] { return std::make_unique<PyramidLevels>(volume.Edges, Metric::Voxels); });
  }
}

void SegmentationLevels::ReadPoints(const SegmentationRequest& request)
{
  const SegmentationSettings& settings = request.Settings;
  std::vector<AttractingPoint> points = PrefixErrors("Input port 2 (Attracting Points): ",
    [&]
    {
      return AttractingPointsOf(
        request.AttractingPoints, this->GetComputationalSpace(), this->Voxels.SizeOf(0));
    });
  for (const Point& position : PositionsOf(settings.AttractingPositions, "Attracting Positions",
         this->GetComputationalSpace(), this->Voxels.SizeOf(0)))
  {
    points.emplace_back();
    points.back().Position = position;
  }
  if (!points.empty() && settings.Options.PointAttractionWeight > 0.0)
  {
    this->Points =
      std::make_unique<PointAttraction>(std::move(points), settings.Options.PointAttractionWeight);
  }
}

void SegmentationLevels::ReadSeeds(const SegmentationRequest& request)
{
  if (request.Settings.Initialization != InitializationType::Seeds)
  {
    return;
  }
  this->SeedErrorPrefix =
    request.InitialSurface ? "Input port 1 (Initial Surface): " : "Seed Positions: ";
  this->SeedPoints = PrefixErrors(this->SeedErrorPrefix,
    [&] { return SeedsOf(request.InitialSurface, this->GetComputationalSpace()); });
  const std::vector<Point> more = PositionsOf(request.Settings.End.SeedPositions, "Seed Positions",
    this->GetComputationalSpace(), this->Voxels.SizeOf(0));
  this->SeedPoints.insert(this->SeedPoints.end(), more.begin(), more.end());
}

namespace
{
/** @param highest highest value of the field at the seeds */
[[noreturn]] void ThrowInvalidSeeds(
  std::size_t seeds, float highest, const SegmentationSettings& settings)
{
  const bool isOne = seeds == 1;
  const bool isBright = settings.Options.ObjectIsBright;
  const ValueRange range = settings.Range();
  const std::string which = isOne ? "the seed is not" : Join("none of the ", seeds, " seeds is");
  const std::string what = Join(which, " inside the object, whose values are ");
  const std::string move = Join(". Move ", isOne ? "it" : "one", " into the object, or set ");
  if (range.IsUsed())
  {
    ThrowInvalidArgument(what, isBright ? "" : "not ", "between Iso Value ", range.Lower,
      " and Upper Value ", range.Upper, move, "other values.");
  }
  const double value = range.Lower + static_cast<double>(isBright ? highest : -highest);
  ThrowInvalidArgument(what, isBright ? "above" : "below", " Iso Value ", range.Lower,
    ": the value at the seed", isOne ? "" : "s", " is ",
    isOne ? "" : (isBright ? "at most " : "at least "), value, move,
    isBright ? "a lower" : "a higher", " Iso Value.");
}
}

void SegmentationLevels::TestSeeds(
  const SegmentationSettings& settings, int coarsest, Executor& threads)
{
  if (this->SeedPoints.empty() || !this->Inside.empty())
  {
    return;
  }
  for (int level = 0; level <= coarsest; ++level)
  {
    const Field field(this->Load(level, settings.Options, threads), settings.Options, threads);
    const std::vector<float> values =
      PrefixErrors(this->SeedErrorPrefix, [&] { return ValuesAtSeeds(field, this->SeedPoints); });
    if (level == 0)
    {
      const float highest = *std::max_element(values.begin(), values.end());
      if (!(highest > 0))
      {
        PrefixErrors(
          this->SeedErrorPrefix, [&] { ThrowInvalidSeeds(values.size(), highest, settings); });
      }
      std::vector<Point> inside;
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        if (values[i] > 0)
        {
          inside.push_back(this->SeedPoints[i]);
        }
      }
      this->SeedPoints = std::move(inside);
    }
    this->Inside.push_back(static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](float value) { return value > 0; })));
  }
}

std::array<double, 2> SegmentationLevels::Range(int level) const
{
  return PrefixErrors(VoxelErrorPrefix, [&] { return this->Voxels.Range(level); });
}

bool SegmentationLevels::ContainsObject(int level, const SurfaceOptions& options) const
{
  const auto found = this->HasObject.find(level);
  if (found != this->HasObject.end())
  {
    return found->second;
  }
  const PartSize least =
    options.RecoverMissedParts ? PartSize{ options.MinimumPartSize, 1 } : SmallestPart;
  return this->HasObject[level] =
           this->Voxels.ContainsPart(level, least, options.IsoValue, options.ObjectIsBright);
}

LevelImage SegmentationLevels::Load(int level, const SurfaceOptions& options, Executor& threads)
{
  const double background = BackgroundOf(this->Range(std::max(level, 0)), options);
  LevelImage image = PrefixErrors(VoxelErrorPrefix,
    [&] { return this->Voxels.Load(level, options.IsoValue, background, threads); });
  if (this->Edges)
  {
    image.Edges = this->LoadEdges(level, image.Size, threads);
  }
  if (this->Points)
  {
    this->Modified = this->Points->Bend(image, options, threads);
    image.Values = this->Modified.data();
  }
  return image;
}

VoxelValues SegmentationLevels::LoadEdges(
  int level, const std::array<int, 3>& size, Executor& threads)
{
  return PrefixErrors(EdgeErrorPrefix,
    [&]
    {
      // The force depends on differences only.
      const double lowest = this->Edges->Range(0)[0];
      const LevelImage loaded = level < this->Edges->NumberOfLevels()
        ? this->Edges->Load(level, lowest, lowest, threads)
        : LevelImage();
      if (loaded.Size != size)
      {
        ThrowInvalidArgument("level ", level, " has ", loaded.Size[0], " x ", loaded.Size[1], " x ",
          loaded.Size[2], " voxels, but the level of the image has ", size[0], " x ", size[1],
          " x ", size[2], ". Connect the image, or a pyramid whose blocks all have both arrays.");
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
  this->Modified = std::vector<float>();
}
}
