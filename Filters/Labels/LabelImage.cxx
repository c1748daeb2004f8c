// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelImage.h"

#include "Core/Common/Spans.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Input/ComputationalSpace.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/LabelValues.h"
#include "Input/ValueHints.h"
#include "Labels/LabelNames.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkPolyData.h>
#include <vtkTriangle.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <type_traits>
#include <unordered_map>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::size_t Grain = 1 << 18;

/** Return the number and extent of the voxels from `first` to `last`, in the order of memory. */
LabelVoxels RunOf(const int* extent, vtkIdType first, vtkIdType last)
{
  const vtkIdType row = extent[1] - extent[0] + 1;
  const vtkIdType slice = row * (extent[3] - extent[2] + 1);
  const auto index = [](vtkIdType value) { return static_cast<int>(value); };
  LabelVoxels run;
  run.Count = last - first + 1;
  std::copy_n(extent, 6, run.Extent.begin());
  if (first / row == last / row)
  {
    run.Extent[0] = extent[0] + index(first % row);
    run.Extent[1] = extent[0] + index(last % row);
  }
  if (first / slice == last / slice)
  {
    run.Extent[2] = extent[2] + index(first % slice / row);
    run.Extent[3] = extent[2] + index(last % slice / row);
  }
  run.Extent[4] = extent[4] + index(first / slice);
  run.Extent[5] = extent[4] + index(last / slice);
  return run;
}
}

void LabelVoxels::Add(const LabelVoxels& others)
{
  for (int axis = 0; axis < 3 && this->Count > 0; ++axis)
  {
    const std::size_t first = 2 * static_cast<std::size_t>(axis);
    this->Extent[first] = std::min(this->Extent[first], others.Extent[first]);
    this->Extent[first + 1] = std::max(this->Extent[first + 1], others.Extent[first + 1]);
  }
  this->Extent = this->Count > 0 ? this->Extent : others.Extent;
  this->Count += others.Count;
}

LabelImage::LabelImage(
  vtkDataObject* input, vtkInformation* selection, int background, Executor& executor)
{
  const PointVoxels points = ConvertCellsToPoints(ImageOf(input), selection);
  this->Voxels = ContiguousVoxels(ChooseVoxels(points.Selection, points.Image));
  this->Geometry = points.Image;
  const int* size = this->Geometry->GetDimensions();
  if (std::min({ size[0], size[1], size[2] }) < 2)
  {
    ThrowInvalidArgument("the image has ", SizeOf(this->Geometry),
      " voxels; it must have at least 2 along each axis. For contours of a single slice apply "
      "Contour (vtkFlyingEdges2D).");
  }
  LabelValues values = LabelValuesOf(this->Voxels, background, MostLabels, executor);
  this->Voxels = values.Voxels;
  this->Numbers = std::move(values.Numbers);
  this->Conversions = std::move(values.Conversions);
  this->CountLabels(executor);
}

void LabelImage::CountLabels(Executor& executor)
{
  std::mutex mutex;
  const auto count = static_cast<std::size_t>(this->Voxels->GetNumberOfTuples());
  const int* extent = this->Geometry->GetExtent();
  VisitVoxels(this->Voxels,
    [&](const auto* voxels)
    {
      using Value = std::decay_t<decltype(*voxels)>;
      ForSpans(executor, count, Grain,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
          std::unordered_map<int, LabelVoxels> counts;
          for (std::size_t i = begin; i < end;)
          {
            const Value value = voxels[i];
            const std::size_t first = i;
            while (i < end && voxels[i] == value)
            {
              ++i;
            }
            counts[static_cast<int>(value)].Add(
              RunOf(extent, static_cast<vtkIdType>(first), static_cast<vtkIdType>(i) - 1));
          }
          const std::lock_guard<std::mutex> lock(mutex);
          for (const auto& entry : counts)
          {
            this->Counts[entry.first].Add(entry.second);
          }
        });
    });
}

void LabelImage::CheckNumberOfLabels() const
{
  if (this->Counts.size() > MostLabels)
  {
    ThrowInvalidArgument(NameOf(this->Voxels), " has ", this->Counts.size(),
      " different values, more than ", MostLabels,
      "; it is probably not a label map. Select some Labels if it is. For the surface of a scan "
      "apply "
      "Volume to Surface (vtkVolumeToSurface).");
  }
}

std::vector<int> LabelImage::Choose(const std::vector<int>& requested, int background) const
{
  std::vector<int> labels = requested;
  if (requested.empty() || requested.size() > MostLabels)
  {
    this->CheckNumberOfLabels();
  }
  if (requested.empty())
  {
    for (const auto& entry : this->Counts)
    {
      if (entry.first != background)
      {
        labels.push_back(entry.first);
      }
    }
  }
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  if (labels.empty())
  {
    ThrowInvalidArgument(NameOf(this->Voxels), " has no label except Background Label, ",
      background, ". Choose another Background Label.");
  }
  for (const int label : labels)
  {
    if (this->Counts.find(label) == this->Counts.end())
    {
      constexpr std::size_t mostListed = 20;
      std::vector<std::string> present;
      for (const auto& entry : this->Counts)
      {
        present.push_back(std::to_string(entry.first));
      }
      ThrowInvalidArgument("Labels: ", NameOf(this->Voxels), " has no label ", label,
        ". Select from ", Listed(present, mostListed), ".");
    }
  }
  return labels;
}

LabelMap LabelImage::MakeMap(const std::vector<int>& selected, bool merge, int background,
  std::vector<int>& objects, Executor& executor) const
{
  constexpr int reserved = 8; // numbers after the objects, such as the sides of the box
  const int* size = this->Geometry->GetDimensions();
  LabelMap map({ size[0], size[1], size[2] });
  map.Spacing = ComputationalSpace(this->Geometry, Metric::World).Step();
  std::unordered_map<int, LabelMap::Number> numbers;
  int room =
    std::numeric_limits<LabelMap::Number>::max() - reserved - static_cast<int>(selected.size());
  for (const auto& [label, voxels] : this->Counts)
  {
    const bool isSelected = std::binary_search(selected.begin(), selected.end(), label);
    if (isSelected && merge && !objects.empty())
    {
      numbers[label] = static_cast<LabelMap::Number>(objects.front());
    }
    else if (isSelected || (label != background && room-- > 0))
    {
      numbers[label] = static_cast<LabelMap::Number>(++map.NumberOfObjects);
      objects.insert(objects.end(), isSelected ? 1 : 0, map.NumberOfObjects);
    }
  }
  VisitVoxels(this->Voxels,
    [&](const auto* voxels)
    {
      ForSpans(executor, static_cast<std::size_t>(map.NumberOfLayers()), 1,
        [&](std::size_t layer, std::size_t, std::size_t)
        {
          const VoxelBox box = map.Layer(static_cast<int>(layer));
          std::vector<LabelMap::Number> slices(static_cast<std::size_t>(box.Count()));
          const auto* from = voxels + VoxelBox::Of(map.Size()).NumberOf(0, 0, box.First[2]);
          for (std::size_t i = 0; i < slices.size();)
          {
            const auto value = from[i];
            const auto found = numbers.find(static_cast<int>(value));
            const LabelMap::Number object = found == numbers.end() ? 0 : found->second;
            for (; i < slices.size() && from[i] == value; ++i)
            {
              slices[i] = object;
            }
          }
          map.PutLayer(static_cast<int>(layer), slices.data());
        });
    });
  return map;
}

std::string LabelImage::ScanWarning(int background) const
{
  return HintAtScan(this->Voxels, this->Geometry->GetDimensions(),
    this->Counts.size() - this->Counts.count(background));
}

void LabelImage::FindNearest(
  vtkPolyData* surface, const std::vector<int>& labels, vtkIntArray* found) const
{
  const ComputationalSpace space(this->Geometry, Metric::Voxels);
  const Point step = ComputationalSpace(this->Geometry, Metric::World).Step();
  const int* size = this->Geometry->GetDimensions();
  const VoxelBox all = VoxelBox::Of({ size[0], size[1], size[2] });
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(count, corners);
    double points[3][3];
    for (int c = 0; c < 3; ++c)
    {
      surface->GetPoint(corners[c], points[c]);
    }
    Point centroid;
    vtkTriangle::TriangleCenter(points[0], points[1], points[2], centroid.data());
    const Point position = space.ToComputationalSpace(centroid);
    int nearest = labels.front();
    double least = std::numeric_limits<double>::max();
    // A surface has voxels of its labels among the 4 x 4 x 4 around each position.
    for (int n = 0; n < 64; ++n)
    {
      const std::array<int, 3> offset = { n % 4 - 1, n / 4 % 4 - 1, n / 16 - 1 };
      std::array<int, 3> at;
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        at[axis] = static_cast<int>(std::floor(position[axis])) + offset[axis];
        square += std::pow((at[axis] - position[axis]) * step[axis], 2.0);
      }
      if (square >= least || !all.Contains(at))
      {
        continue;
      }
      const int label =
        static_cast<int>(this->Voxels->GetComponent(all.NumberOf(at[0], at[1], at[2]), 0));
      if (std::binary_search(labels.begin(), labels.end(), label))
      {
        least = square;
        nearest = label;
      }
    }
    found->SetValue(surface->GetNumberOfLines() + cells->GetCurrentCellId(), nearest);
  }
}
}
