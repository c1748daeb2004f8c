// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValueHints.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Host/HostThreads.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkType.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <set>
#include <unordered_map>
#include <vector>

namespace volumic
{
namespace
{
constexpr int Bins = 1024;

using Counts = std::vector<vtkIdType>;

/** How many voxels each bin between the smallest and the largest voxel has. */
template <typename T>
Counts CountVoxels(const T* voxels, vtkIdType count, const ValidVoxels& valid,
  const std::array<double, 2>& range, Executor& threads)
{
  const double scale = Bins / (range[1] - range[0]);
  Counts all(Bins, 0);
  std::mutex mutex;
  threads.For(static_cast<std::size_t>(count), 1 << 18,
    [&](std::size_t begin, std::size_t end)
    {
      Counts counts(Bins, 0);
      for (std::size_t i = begin; i < end; ++i)
      {
        if (valid.Has(static_cast<std::int64_t>(i)))
        {
          const double place = (static_cast<double>(voxels[i]) - range[0]) * scale;
          ++counts[std::min(Bins - 1, static_cast<int>(place))];
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      std::transform(all.begin(), all.end(), counts.begin(), all.begin(), std::plus<>());
    });
  return all;
}

/** The bins below the split with the largest variance between the classes. */
int BestSplit(const Counts& counts)
{
  // Bins stand for the values, which follow from them by a scale that changes no maximum.
  double all = 0.0;
  double sum = 0.0;
  for (int bin = 0; bin < Bins; ++bin)
  {
    all += static_cast<double>(counts[bin]);
    sum += static_cast<double>(counts[bin]) * bin;
  }
  std::vector<double> variance(Bins - 1, 0.0);
  double low = 0.0;
  double lowSum = 0.0;
  for (int bin = 0; bin < Bins - 1; ++bin)
  {
    low += static_cast<double>(counts[bin]) / all;
    lowSum += static_cast<double>(counts[bin]) * bin / all;
    const double difference = sum / all * low - lowSum;
    variance[bin] = low > 0.0 && low < 1.0 ? difference * difference / (low * (1.0 - low)) : 0.0;
  }
  const double best = *std::max_element(variance.begin(), variance.end()) * (1.0 - 1e-12);
  std::vector<int> splits;
  for (int bin = 0; bin < Bins - 1; ++bin)
  {
    if (variance[bin] >= best)
    {
      splits.push_back(bin + 1);
    }
  }
  return splits[splits.size() / 2];
}

/** The largest voxel up to a value, and the smallest one above that. */
template <typename T>
std::array<double, 2> FindNeighbours(
  const T* voxels, vtkIdType count, const ValidVoxels& valid, double value)
{
  T below = std::numeric_limits<T>::lowest();
  T above = std::numeric_limits<T>::max();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const T voxel = voxels[i];
    if (!valid.Has(i))
    {
      continue;
    }
    if (static_cast<double>(voxel) <= value)
    {
      below = std::max(below, voxel);
    }
    else
    {
      above = std::min(above, voxel);
    }
  }
  return { static_cast<double>(below), static_cast<double>(above) };
}

/**
 * Has no value what lies outside the circle that a CT is reconstructed in, such as -2000 or -3024:
 * less than any matter has, a hundredth of the voxels or more, and none is near. @return whether
 * there is such padding.
 */
template <typename T>
bool LeaveOutPadding(
  const T* voxels, vtkIdType count, const std::array<double, 2>& range, ValidVoxels& valid)
{
  constexpr double air = -1024.0;
  constexpr double gap = 400.0;
  constexpr std::size_t leastValues = 16; // Fewer are a drawing, not a scan.
  const double next = range[0] < air ? FindNeighbours(voxels, count, valid, range[0])[1] : range[0];
  if (next - range[0] < gap || !(next < range[1]))
  {
    return false;
  }
  std::set<T> others;
  ValidVoxels without = valid;
  without.Marks.resize(static_cast<std::size_t>(count), 1);
  vtkIdType padding = 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (static_cast<double>(voxels[i]) == range[0])
    {
      without.Marks[static_cast<std::size_t>(i)] = 0;
      ++padding;
    }
    else if (valid.Has(i) && others.size() < leastValues)
    {
      others.insert(voxels[i]);
    }
  }
  const bool isPadding = padding >= count / 100 && others.size() == leastValues;
  valid = isPadding ? without : valid;
  return isPadding;
}
}

VoxelHistogram FindOtsuThreshold(
  vtkImageData* image, vtkInformation* selection, int component, int numberOfThreads)
{
  const vtkSmartPointer<vtkDataArray> chosen =
    SelectComponent(ChooseArray(selection, image), component);
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(chosen);
  HostThreads threads(numberOfThreads);
  ValidVoxels valid = FindValidVoxels(chosen, voxels, image, true, threads);
  CheckAnyIsValid(chosen, valid);
  std::array<double, 2> range = RangeOf(voxels, valid);
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      if (LeaveOutPadding(values, voxels->GetNumberOfTuples(), range, valid))
      {
        range = RangeOf(voxels, valid);
      }
    });
  const double size = range[1] - range[0];
  if (!(size > 0.0) || !std::isfinite(size))
  {
    Refuse(NameOf(chosen), " ranges from ", range[0], " to ", range[1],
      ": no value separates its voxels.");
  }
  VoxelHistogram found{ range, {}, 0.0 };
  VisitVoxels(voxels,
    [&](const auto* values)
    { found.Counts = CountVoxels(values, voxels->GetNumberOfTuples(), valid, range, threads); });
  const double value = range[0] + BestSplit(found.Counts) * size / Bins;
  std::array<double, 2> neighbours = range;
  VisitVoxels(voxels,
    [&](const auto* values)
    { neighbours = FindNeighbours(values, voxels->GetNumberOfTuples(), valid, value); });
  const double middle = 0.5 * (neighbours[0] + neighbours[1]);
  const bool areReal = voxels->GetDataType() == VTK_FLOAT || voxels->GetDataType() == VTK_DOUBLE;
  found.Threshold = areReal ? middle : std::floor(middle) + 0.5;
  return found;
}

namespace
{
/** About as many voxels are looked at. */
constexpr vtkIdType MostVoxels = 1 << 20;
/** More different values in them are no labels. */
constexpr std::size_t MostValues = 1024;
/**
 * Share of equal neighbours from which on voxels are labels. Of nine atlases the least is 0.82; of
 * fourteen scans, half of them of 8 bits, the most is 0.57, and that one is saturated.
 */
constexpr double LeastShareOfEqual = 0.75;
/** Fewer pairs of neighbours tell nothing. */
constexpr vtkIdType LeastPairs = 50;

/** Of one value. */
struct Neighbours
{
  vtkIdType Voxels = 0;
  vtkIdType Equal = 0;   ///< pairs of this value
  vtkIdType Unequal = 0; ///< pairs of it and another one
};

template <typename T>
bool LookLikeLabels(const T* voxels, const int size[3], std::size_t& count)
{
  const vtkIdType rows = static_cast<vtkIdType>(size[1]) * size[2];
  const vtkIdType step = std::max<vtkIdType>(1, rows * size[0] / MostVoxels);
  std::unordered_map<double, Neighbours> found;
  vtkIdType unequal = 0;
  for (vtkIdType row = 0; row < rows; row += step)
  {
    const T* values = voxels + row * size[0];
    for (int i = 0; i < size[0]; ++i)
    {
      const auto value = static_cast<double>(values[i]);
      if (!(value == std::floor(value)) || found.size() > MostValues)
      {
        return false;
      }
      Neighbours& own = found[value];
      ++own.Voxels;
      if (i > 0)
      {
        const bool isEqual = values[i - 1] == values[i];
        own.Equal += isEqual;
        own.Unequal += !isEqual;
        unequal += !isEqual;
        found[static_cast<double>(values[i - 1])].Unequal += !isEqual;
      }
    }
  }
  count = found.size();
  const auto background = std::max_element(found.begin(), found.end(),
    [](const auto& a, const auto& b) { return a.second.Voxels < b.second.Voxels; });
  unequal -= background->second.Unequal;
  vtkIdType equal = -background->second.Equal;
  for (const auto& entry : found)
  {
    equal += entry.second.Equal;
  }
  return equal + unequal >= LeastPairs &&
    static_cast<double>(equal) >= LeastShareOfEqual * static_cast<double>(equal + unequal);
}
}

std::string HintAtLabels(vtkDataArray* voxels, const int size[3])
{
  bool areLabels = false;
  std::size_t count = 0;
  VisitVoxels(voxels, [&](const auto* values) { areLabels = LookLikeLabels(values, size, count); });
  return areLabels
    ? Join(NameOf(voxels), " looks like a label map: ", count,
        " different integers. Labels to Surfaces (vtkLabelsToSurfaces) makes a smooth surface of "
        "each label; here an isopotential between them is searched.")
    : std::string();
}

namespace
{
/** The share of neighbours along the axes that differ. */
template <typename T>
double ShareOfUnequal(const T* voxels, const int size[3])
{
  const vtkIdType rows = static_cast<vtkIdType>(size[1]) * size[2];
  const vtkIdType step = std::max<vtkIdType>(1, rows * size[0] / MostVoxels);
  const std::array<vtkIdType, 3> strides = { 1, size[0],
    static_cast<vtkIdType>(size[0]) * size[1] };
  vtkIdType pairs = 0;
  vtkIdType unequal = 0;
  for (vtkIdType row = 0; row < rows; row += step)
  {
    for (int i = 0; i < size[0]; ++i)
    {
      const T* voxel = voxels + row * size[0] + i;
      const std::array<vtkIdType, 3> at = { i, row % size[1], row / size[1] };
      for (int axis = 0; axis < 3; ++axis)
      {
        pairs += at[axis] > 0;
        unequal += at[axis] > 0 && voxel[-strides[axis]] != *voxel;
      }
    }
  }
  return static_cast<double>(unequal) / static_cast<double>(std::max<vtkIdType>(pairs, 1));
}
}

std::string HintAtScan(vtkDataArray* voxels, const int size[3], std::size_t labels)
{
  constexpr std::size_t mostLabels = 256;
  constexpr double mostUnequal = 1.0 / 3.0;
  double share = 0.0;
  if (labels > mostLabels)
  {
    VisitVoxels(voxels, [&](const auto* values) { share = ShareOfUnequal(values, size); });
  }
  return share > mostUnequal
    ? Join(NameOf(voxels), " has ", labels, " labels, and ", std::lround(100.0 * share),
        " % of neighbouring voxels have different ones: it looks like a scan, not like a label "
        "map. "
        "For an isosurface of a scan apply Volume to Surface (vtkVolumeToSurface) or Deformable "
        "Surface (vtkDeformableSurface), or run volumic with --iso.")
    : std::string();
}
}
