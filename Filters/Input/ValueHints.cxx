// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValueHints.h"

#include "Core/Common/Join.h"
#include "Core/Common/ThrowInvalidArgument.h"
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
#include <limits>
#include <numeric>
#include <set>
#include <type_traits>
#include <unordered_map>
#include <vector>

namespace volumic
{
namespace
{
constexpr int Bins = 1024;

/** Return the split of the bins from `first` on with the largest variance between the classes. */
int BestSplit(const std::vector<vtkIdType>& counts, int first = 0)
{
  // Bin numbers replace the values: a scale does not change the position of the maximum.
  double all = 0.0;
  double sum = 0.0;
  for (int bin = first; bin < Bins; ++bin)
  {
    all += static_cast<double>(counts[bin]);
    sum += static_cast<double>(counts[bin]) * bin;
  }
  std::vector<double> variance(Bins - 1, 0.0);
  double low = 0.0;
  double lowSum = 0.0;
  for (int bin = first; bin < Bins - 1; ++bin)
  {
    low += static_cast<double>(counts[bin]) / all;
    lowSum += static_cast<double>(counts[bin]) * bin / all;
    const double difference = sum / all * low - lowSum;
    variance[bin] = low > 0.0 && low < 1.0 ? difference * difference / (low * (1.0 - low)) : 0.0;
  }
  const double best = *std::max_element(variance.begin(), variance.end()) * (1.0 - 1e-12);
  std::vector<int> splits;
  for (int bin = first; bin < Bins - 1; ++bin)
  {
    if (variance[bin] >= best)
    {
      splits.push_back(bin + 1);
    }
  }
  return splits[splits.size() / 2];
}

/** Return BrightThreshold of a histogram with Otsu's split. */
double FindBrightThreshold(const VoxelHistogram& found, int split)
{
  // In 14 scans, seven have such a part, with 0.9 % (engine) to 6.2 % (tooth) of the voxels.
  constexpr double leastObject = 0.1;
  constexpr double mostBright = 0.1;
  const auto above = [&](int bin)
  { return std::accumulate(found.Counts.begin() + bin, found.Counts.end(), 0.0); };
  const double object = above(split);
  const int second = split < Bins - 1 ? BestSplit(found.Counts, split) : split;
  const double bright = above(second);
  const double value = found.Range[0] + second * (found.Range[1] - found.Range[0]) / Bins;
  const bool hasPart = object >= leastObject * above(0) && bright > 0.0 && bright < object &&
    bright < mostBright * above(0) && value != 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1.0);
  return hasPart ? std::round(value / unit) * unit : std::numeric_limits<double>::quiet_NaN();
}

/** Return the largest voxel up to a value, and the smallest one above it. */
template <typename T>
std::array<double, 2> FindNeighbors(
  const T* voxels, vtkIdType count, const ValidVoxels& valid, double value)
{
  T below = std::numeric_limits<T>::lowest();
  T above = std::numeric_limits<T>::max();
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (valid.Has(i))
    {
      const bool isBelow = static_cast<double>(voxels[i]) <= value;
      below = isBelow ? std::max(below, voxels[i]) : below;
      above = isBelow ? above : std::min(above, voxels[i]);
    }
  }
  return { static_cast<double>(below), static_cast<double>(above) };
}

/**
 * Mark the padding of a CT as not valid, such as -2000 or -3024 outside the reconstruction circle.
 * It is less than the value of air, has at least a hundredth of the voxels, and no other value is
 * near.
 * @return whether there is padding
 */
template <typename T>
bool RemovePadding(
  const T* voxels, vtkIdType count, const std::array<double, 2>& range, ValidVoxels& valid)
{
  constexpr double air = -1024.0;
  constexpr double gap = 400.0;
  constexpr std::size_t leastValues = 16; // A scan has more different values.
  const double next = range[0] < air ? FindNeighbors(voxels, count, valid, range[0])[1] : range[0];
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

template <typename T>
VoxelHistogram SplitVoxels(const T* voxels, vtkDataArray* array, ValidVoxels& valid)
{
  const vtkIdType count = array->GetNumberOfTuples();
  std::array<double, 2> range = RangeOf(array, valid);
  if (RemovePadding(voxels, count, range, valid))
  {
    range = RangeOf(array, valid);
  }
  const double size = range[1] - range[0];
  if (!(size > 0.0) || !std::isfinite(size))
  {
    ThrowInvalidArgument(NameOf(array), " ranges from ", range[0], " to ", range[1],
      ", so no value separates its voxels. Choose another array or component.");
  }
  VoxelHistogram found;
  found.Range = range;
  found.Counts.assign(Bins, 0);
  const double scale = Bins / size;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (valid.Has(i))
    {
      const double bin = (static_cast<double>(voxels[i]) - range[0]) * scale;
      ++found.Counts[std::min(Bins - 1, static_cast<int>(bin))];
    }
  }
  const int split = BestSplit(found.Counts);
  const double value = range[0] + split * size / Bins;
  const std::array<double, 2> neighbors = FindNeighbors(voxels, count, valid, value);
  const double middle = 0.5 * (neighbors[0] + neighbors[1]);
  found.Threshold = std::is_floating_point_v<T> ? middle : std::floor(middle) + 0.5;
  found.BrightThreshold = FindBrightThreshold(found, split);
  return found;
}
}

VoxelHistogram FindOtsuThreshold(vtkImageData* image, vtkInformation* selection, int component)
{
  const vtkSmartPointer<vtkDataArray> voxels =
    ContiguousVoxels(SelectComponent(ChooseArray(selection, image), component));
  ValidVoxels valid = FindValidVoxels(voxels, voxels, image, true, OnThisThread());
  CheckAnyIsValid(voxels, valid);
  VoxelHistogram found;
  VisitVoxels(voxels, [&](const auto* values) { found = SplitVoxels(values, voxels, valid); });
  return found;
}

namespace
{
constexpr std::size_t MostValues = 1024;
/**
 * Minimum fraction of equal neighbors in a label map. Nine atlases have at least 0.82. Fourteen
 * scans, half of them of 8 bits, have at most 0.57, in a saturated one.
 */
constexpr double MinimumFractionOfEqual = 0.75;
constexpr vtkIdType MinimumPairs = 50;

/** Call `use` with the first voxels of rows with about a million voxels in total. */
template <typename T, typename Use>
void ForSomeRows(const T* voxels, const int size[3], const Use& use)
{
  constexpr vtkIdType mostVoxels = 1 << 20;
  const vtkIdType rows = static_cast<vtkIdType>(size[1]) * size[2];
  for (vtkIdType row = 0; row < rows; row += std::max<vtkIdType>(1, rows * size[0] / mostVoxels))
  {
    use(voxels + row * size[0]);
  }
}

/** Return the number of different values if they look like labels, or 0. */
template <typename T>
std::size_t CountLabels(const T* voxels, const int size[3])
{
  std::unordered_map<double, vtkIdType> counts;
  bool areLabels = true;
  ForSomeRows(voxels, size,
    [&](const T* row)
    {
      for (int i = 0; i < size[0] && areLabels; ++i)
      {
        const auto value = static_cast<double>(row[i]);
        areLabels = value == std::floor(value) && counts.size() <= MostValues;
        ++counts[value];
      }
    });
  if (!areLabels || counts.empty())
  {
    return 0;
  }
  const double background = std::max_element(counts.begin(), counts.end(),
    [](const auto& a, const auto& b) {
      return a.second < b.second;
    })->first;
  vtkIdType pairs = 0;
  vtkIdType equal = 0;
  ForSomeRows(voxels, size,
    [&](const T* row)
    {
      for (int i = 1; i < size[0]; ++i)
      {
        const bool isPair = static_cast<double>(row[i - 1]) != background &&
          static_cast<double>(row[i]) != background;
        pairs += isPair;
        equal += isPair && row[i - 1] == row[i];
      }
    });
  return pairs >= MinimumPairs &&
      static_cast<double>(equal) >= MinimumFractionOfEqual * static_cast<double>(pairs)
    ? counts.size()
    : 0;
}
}

std::string HintAtLabels(vtkDataArray* voxels, const int size[3])
{
  std::size_t count = 0;
  VisitVoxels(voxels, [&](const auto* values) { count = CountLabels(values, size); });
  return count > 0
    ? Join(NameOf(voxels), " looks like a label map: it has ", count,
        " different integers. For a smooth surface of each label apply Labels to Surfaces "
        "(vtkLabelsToSurfaces); this filter computes one isosurface.")
    : std::string();
}

std::string HintAtScan(vtkDataArray* voxels, const int size[3], std::size_t labels)
{
  constexpr std::size_t mostLabels = 256;
  constexpr double mostUnequal = 1.0 / 3.0;
  vtkIdType pairs = 0;
  vtkIdType unequal = 0;
  const auto count = [&](const auto* row)
  {
    for (int i = 1; i < size[0]; ++i)
    {
      ++pairs;
      unequal += row[i - 1] != row[i];
    }
  };
  if (labels > mostLabels)
  {
    VisitVoxels(voxels, [&](const auto* values) { ForSomeRows(values, size, count); });
  }
  const double fraction =
    static_cast<double>(unequal) / static_cast<double>(std::max<vtkIdType>(pairs, 1));
  return fraction > mostUnequal
    ? Join(NameOf(voxels), " has ", labels, " labels, and ", std::lround(100.0 * fraction),
        " % of the neighbors along x differ, so it looks like a scan, not like a label map. For an "
        "isosurface of a scan apply Volume to Surface (vtkVolumeToSurface) or Deformable Surface "
        "(vtkDeformableSurface), or run volumic with --iso.")
    : std::string();
}
}
