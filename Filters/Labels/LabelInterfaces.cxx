// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelInterfaces.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Interfaces/MismatchedVoxels.h"
#include "Core/Labels/LabelMapPadding.h"
#include "Core/Labels/SmallParts.h"
#include "Core/Surface/SizingField.h"
#include "Settings/SegmentationSettings.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/**
 * Return the margin around the objects in voxels: whole bricks that cover the Gaussian, minus one
 * brick, which fields add beyond the map.
 */
int MarginFor(double sigma)
{
  constexpr int side = LabelBricks::Side;
  const int reach = static_cast<int>(std::ceil(3.0 * sigma)) - side;
  return std::max(1, (reach + side - 1) / side) * side;
}

/** Minimum period in edge lengths. Its two ends must not be close to each other. */
constexpr double MinimumPeriod = 4.;

/** Relative volume error above which a part counts in `WrongParts`. */
constexpr double MaximumVolumeError = 0.25;

constexpr double FieldFraction = 0.4;

/** Return the box of all objects, or of the whole map, in whole bricks. */
VoxelBox BoxOf(const LabelMap& map, bool isWhole)
{
  constexpr int side = LabelBricks::Side;
  VoxelBox box = isWhole ? VoxelBox::Of(map.Size()) : VoxelBox();
  map.ForParts(VoxelBox::Of(map.Size()),
    [&](const VoxelBox& part, LabelMap::Number object)
    { box = object > 0 ? box.With(part) : box; });
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] -= box.First[axis] % side;
    box.End[axis] += (side - box.Length(axis) % side) % side;
  }
  return box;
}
}

LabelInterfaceMaker::LabelInterfaceMaker(LabelMap map, std::vector<int> selected,
  vtkImageData* image, const LabelSettings& settings, HostThreads& threads)
  : Settings(settings), Selected(std::move(selected)),
    Space(image, static_cast<Metric>(settings.Metric))
{
  const bool isFlat = settings.HasFlatBox();
  // With flat faces labels continue beyond them, for the whole Gaussian.
  const int margin = MarginFor(settings.FieldOptions(map).Sigma) + (isFlat ? LabelBricks::Side : 0);
  const VoxelBox box = BoxOf(map, settings.IsPeriodic()).Grown(margin);
  this->First = box.First;
  const auto keep = static_cast<KeepComponentsType>(settings.KeepComponents);
  if (keep != KeepComponentsType::AllComponents)
  {
    const double ofVoxel =
      map.Spacing[0] * map.Spacing[1] * map.Spacing[2] * std::pow(this->Space.WorldUnit(), 3.0);
    const double least = std::min(std::ceil(settings.MinimumComponentVolume / ofVoxel),
      static_cast<double>(VoxelBox::Of(map.Size()).Count()) + 1.0);
    this->WholeMap = map.Part(box);
    this->WholeBricks.emplace(this->WholeMap, threads);
    ReassignSmallParts(map, this->Selected, static_cast<std::int64_t>(least),
      keep == KeepComponentsType::LargestComponent);
  }
  this->Map = map.Part(box);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Image.First[axis] = -this->First[axis];
    this->Image.End[axis] = map.Size()[axis] - this->First[axis];
  }
  this->InImage = this->Image.CommonWith(VoxelBox::Of(this->Map.Size()));
  if (settings.IsPeriodic())
  {
    this->CheckPeriod();
  }
  if (!settings.IsPeriodic()) // Parts of a periodic map may continue at the opposite side.
  {
    SeparateParts(this->Map);
  }
  if (isFlat)
  {
    PadLabelMap(this->Map, this->InImage, settings.IsPeriodic());
  }
  this->Bricks.emplace(this->Map, threads, isFlat ? this->InImage : VoxelBox::Of(this->Map.Size()));
}

void LabelInterfaceMaker::CheckPeriod() const
{
  CheckPeriodic(this->Map, this->InImage);
  const double edge = this->EdgeLength();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double period = this->InImage.Length(axis) * this->Space.Step()[axis];
    if (period < MinimumPeriod * edge)
    {
      ThrowInvalidArgument("Box Faces is periodic, but the length of the image along ", "xyz"[axis],
        " is ", period * this->Space.WorldUnit(), ", less than ", MinimumPeriod,
        " edge lengths of ", edge * this->Space.WorldUnit(),
        ". Set a shorter Edge Length, or set Box Faces to flat.");
    }
  }
}

double LabelInterfaceMaker::EdgeLength() const
{
  return this->Settings.EdgeLength != 0.0 ? this->Settings.EdgeLength / this->Space.WorldUnit()
                                          : SizingField::RestLengthInDelta *
      SurfaceOptions().SamplingRatio * std::pow(std::sqrt(3.0), this->Settings.FinestLevel);
}

InterfaceOptions LabelInterfaceMaker::Options() const
{
  InterfaceOptions options;
  options.Edge = this->EdgeLength();
  options.VoxelTolerance = this->Settings.VoxelToleranceInUse();
  Grading grading = this->Settings.Grading;
  grading.MaximumEdgeLength /= this->Space.WorldUnit();
  options.Tolerance = grading.Tolerance / this->Space.WorldUnit();
  options.MostSize = grading.Growth(InterfaceOptions::LongestInEdge * options.Edge);
  options.Gradation = SizingField::RestLengthInDelta * grading.Gradation / options.Edge;
  return options;
}

void LabelInterfaceMaker::Make(HostThreads& threads, const Progress& progress)
{
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> continues{ true };
  using Clock = std::chrono::steady_clock;
  Clock::time_point last; // time of the last report
  double reported = 0.0;
  const auto report = [&](double fraction, const char* text)
  {
    constexpr std::chrono::milliseconds interval(50);
    constexpr double step = 0.01;
    if (std::this_thread::get_id() == caller &&
      (fraction >= reported + step || Clock::now() - last >= interval))
    {
      reported = fraction;
      continues = continues.load() && progress(fraction, text);
      last = Clock::now();
    }
    return continues.load();
  };
  this->Fields.emplace(
    *this->Bricks, this->Settings.FieldOptions(this->Map), this->Space.Step(), threads,
    [&](double fraction) { return report(FieldFraction * fraction, "Fields of the labels"); },
    this->Settings.IsPeriodic());
  if (continues)
  {
    this->Mesh = MakeInterfaces(*this->Fields, this->Options(), threads,
      [&](double fraction) {
        return report(FieldFraction + (1.0 - FieldFraction) * fraction, "Interfaces of the labels");
      });
  }
  this->IsFinished = continues;
  this->CountVoxels(threads);
  this->IdOf.assign(this->Mesh.Position.size(), -1);
  for (const InterfaceMesh::Face& face : this->Mesh.Faces)
  {
    for (const int v : face.Vertex)
    {
      int& id = this->IdOf[static_cast<std::size_t>(v)];
      id = this->IsShown(face) ? 0 : id;
    }
  }
  int next = 0;
  for (int& id : this->IdOf)
  {
    id = id == 0 ? next++ : id;
  }
}

void LabelInterfaceMaker::CountVoxels(HostThreads& threads)
{
  const LabelMap& map = this->Map;
  std::vector<double> volumes(static_cast<std::size_t>(map.NumberOfObjects) + 1, 0.);
  const std::array<double, 3>& step = this->Space.Step();
  for (const InterfaceMesh::Face& face : this->Mesh.Faces)
  {
    const VectorD corner(this->Mesh.Position[static_cast<std::size_t>(face.Vertex[0])]);
    const double volume =
      Dot(this->Mesh.NormalOf(face), corner) / (6. * step[0] * step[1] * step[2]);
    volumes[face.Behind] += volume;
    if (!this->Mesh.IsSide(face.Front))
    {
      volumes[face.Front] -= volume;
    }
  }
  const auto isWrong = [](double volume, double voxels)
  { return std::abs(volume - voxels) > MaximumVolumeError * voxels; };
  this->Counts.assign(volumes.size(), LabelSurface());
  std::vector<double> ofWhole(volumes.size(), 0.), voxelsOfWhole = ofWhole;
  for (std::size_t object = 1; object < volumes.size(); ++object)
  {
    const auto whole = static_cast<std::size_t>(map.Whole(static_cast<int>(object)));
    const auto voxels =
      static_cast<double>(this->Bricks->ExtentOf(static_cast<int>(object)).Voxels);
    ofWhole[whole] += volumes[object];
    voxelsOfWhole[whole] += voxels;
    this->Counts[whole].Parts += voxels > 0. ? 1 : 0;
    this->Counts[whole].MisclassifiedParts += isWrong(volumes[object], voxels) ? 1 : 0;
  }
  const std::vector<MismatchedVoxel> mismatched =
    FindMismatchedVoxels(this->Mesh, this->WholeBricks ? this->WholeMap : map, this->Image, step,
      this->Settings.VoxelToleranceInUse() + this->Options().Tolerance, threads);
  for (const MismatchedVoxel& voxel : mismatched)
  {
    const LabelMap::Number objects[2] = { map.Whole(voxel.MapObject), map.Whole(voxel.MeshObject) };
    for (const LabelMap::Number object : objects)
    {
      this->Counts[object].MisclassifiedVoxels += objects[0] != objects[1] ? 1 : 0;
      this->Counts[object].MissedVoxels += objects[0] != objects[1] && voxel.IsFar ? 1 : 0;
    }
  }
  for (std::size_t object = 1; object < volumes.size(); ++object)
  {
    const double voxels = this->WholeBricks
      ? static_cast<double>(this->WholeBricks->ExtentOf(static_cast<int>(object)).Voxels)
      : voxelsOfWhole[object];
    this->Counts[object].VolumeError = voxels > 0. ? ofWhole[object] / voxels - 1. : 0.;
    this->Counts[object].IsFinished = this->IsFinished;
  }
}

int LabelInterfaceMaker::SelectionOf(int object) const
{
  const int whole = this->Map.Whole(object);
  const auto found = std::lower_bound(this->Selected.begin(), this->Selected.end(), whole);
  return found != this->Selected.end() && *found == whole
    ? static_cast<int>(found - this->Selected.begin())
    : -1;
}
}
