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
 * Voxels of nothing about the objects: whole bricks, as far as the Gaussian reaches, less the brick
 * beyond the map that fields have.
 */
int MarginFor(double sigma)
{
  constexpr int side = LabelBricks::Side;
  const int reach = static_cast<int>(std::ceil(3.0 * sigma)) - side;
  return std::max(1, (reach + side - 1) / side) * side;
}

/** A period, at least, in wanted edges: what is at its two ends is far from each other. */
constexpr double LeastPeriod = 4.;

/** Share by which a part's volume is wrong. */
constexpr double MostOff = 0.25;

/** Of the whole work. */
constexpr double FieldShare = 0.4;

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
    box.First[axis] -= box.First[axis] % side; // What is about does not matter.
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
  // With flat faces fields are those of labels that go on beyond them, for the whole Gaussian.
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
    this->InImage.First[axis] = std::max(-this->First[axis], 0);
    this->InImage.End[axis] =
      std::min(map.Size()[axis] - this->First[axis], this->Map.Size()[axis]);
  }
  if (settings.IsPeriodic())
  {
    this->CheckPeriod();
  }
  if (!settings.IsPeriodic()) // There what is cut off by a side goes on at the other one.
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
    if (period < LeastPeriod * edge)
    {
      ThrowInvalidArgument("Box Faces are to be periodic, but the volume is only ",
        period * this->Space.WorldUnit(), " wide along ", "xyz"[axis], ": it must be ", LeastPeriod,
        " Edge Lengths, which are ", edge * this->Space.WorldUnit(),
        ". Set a shorter Edge Length, or Box Faces to flat.");
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
  std::atomic<bool> goesOn{ true };
  using Clock = std::chrono::steady_clock;
  Clock::time_point last; // When the host was asked, and told what.
  double told = 0.0;
  const auto tell = [&](double share, const char* text)
  {
    constexpr std::chrono::milliseconds interval(50);
    constexpr double step = 0.01;
    if (std::this_thread::get_id() == caller &&
      (share >= told + step || Clock::now() - last >= interval))
    {
      told = share;
      goesOn = goesOn.load() && progress(share, text);
      last = Clock::now();
    }
    return goesOn.load();
  };
  this->Fields.emplace(
    *this->Bricks, this->Settings.FieldOptions(this->Map), this->Space.Step(), threads,
    [&](double share) { return tell(FieldShare * share, "Fields of the labels"); },
    this->Settings.IsPeriodic());
  if (goesOn)
  {
    this->Mesh = MakeInterfaces(*this->Fields, this->Options(), threads,
      [&](double share)
      { return tell(FieldShare + (1.0 - FieldShare) * share, "Interfaces of the labels"); });
  }
  this->IsFinished = goesOn;
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
  const double ofVoxel = step[0] * step[1] * step[2];
  for (const InterfaceMesh::Face& face : this->Mesh.Faces)
  {
    const VectorD corner(this->Mesh.Position[static_cast<std::size_t>(face.Vertex[0])]);
    const double volume = Dot(this->Mesh.NormalOf(face), corner) / (6. * ofVoxel);
    volumes[face.Behind] += volume;
    if (!this->Mesh.IsSide(face.Front))
    {
      volumes[face.Front] -= volume;
    }
  }
  const auto isOff = [](double volume, double voxels, double most)
  { return std::abs(volume - voxels) > most * voxels; };
  this->Counts.assign(volumes.size(), LabelSurface());
  std::vector<double> ofWhole(volumes.size(), 0.);
  std::vector<double> voxelsOfWhole = ofWhole;
  for (std::size_t object = 1; object < volumes.size(); ++object)
  {
    const auto whole = static_cast<std::size_t>(map.Whole(static_cast<int>(object)));
    const auto voxels =
      static_cast<double>(this->Bricks->ExtentOf(static_cast<int>(object)).Voxels);
    ofWhole[whole] += volumes[object];
    voxelsOfWhole[whole] += voxels;
    this->Counts[whole].Parts += voxels > 0. ? 1 : 0;
    this->Counts[whole].MisclassifiedParts += isOff(volumes[object], voxels, MostOff) ? 1 : 0;
  }
  const std::vector<MismatchedVoxel> mismatched =
    FindMismatchedVoxels(this->Mesh, this->WholeBricks ? this->WholeMap : map, this->InImage, step,
      this->Settings.VoxelToleranceInUse() + this->Options().Tolerance, threads);
  for (const MismatchedVoxel& voxel : mismatched)
  {
    const LabelMap::Number of[2] = { map.Whole(voxel.OfMap), map.Whole(voxel.OfMesh) };
    for (const LabelMap::Number object : of)
    {
      this->Counts[object].MisclassifiedVoxels += of[0] != of[1] ? 1 : 0;
      this->Counts[object].MissedVoxels += of[0] != of[1] && voxel.IsFar ? 1 : 0;
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
