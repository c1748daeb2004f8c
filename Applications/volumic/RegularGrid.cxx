// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RegularGrid.h"

#include "Texts.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tool
{
namespace
{
/** Tolerated deviation of what two slices lie apart, as a share of it. */
constexpr double Tolerance = 0.05;

/** How many times as many slices the grid may have. */
constexpr double MostRefined = 16.0;

Vector3 Difference(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

std::string Rounded(double length)
{
  return NumberText(std::round(1e3 * length) / 1e3);
}

/** The smallest and the largest distance of two neighbours. */
std::pair<double, double> Distances(const std::vector<double>& heights)
{
  std::pair<double, double> found(std::numeric_limits<double>::infinity(), 0.0);
  for (std::size_t i = 1; i < heights.size(); ++i)
  {
    found.first = std::min(found.first, heights[i] - heights[i - 1]);
    found.second = std::max(found.second, heights[i] - heights[i - 1]);
  }
  return found;
}

class GridOfSlices : public SlabReader
{
public:
  GridOfSlices(std::shared_ptr<SlabReader> slices, const SlicePlaces& places, double outside);

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  /** A slice, and where its first pixel lies among those of the grid. */
  struct Layer
  {
    std::size_t Number = std::numeric_limits<std::size_t>::max();
    vtkSmartPointer<vtkDataArray> Values;
    std::array<double, 2> Shift = { 0, 0 };
  };

  const Layer& Need(std::size_t slice);
  bool Add(const Layer& layer, int x, int y, double weight, double* values) const;
  void FillSlice(int z, vtkDataArray* values, vtkIdType start);

  std::shared_ptr<SlabReader> Slices;
  std::vector<double> Heights;
  std::vector<std::array<double, 2>> Shifts; ///< of the slices, in pixels of the grid
  double Outside;
  std::array<Layer, 2> Layers; ///< those that were read last, by even and odd numbers
};

GridOfSlices::GridOfSlices(
  std::shared_ptr<SlabReader> slices, const SlicePlaces& places, double outside)
  : Slices(std::move(slices)), Heights(places.Heights()), Outside(outside)
{
  static_cast<SlabReader&>(*this) = *this->Slices;
  std::array<double, 2> least = { 0, 0 };
  std::array<double, 2> most = { 0, 0 };
  const std::array<Vector3, 2> axes = { places.Across, places.Down };
  for (const Vector3& position : places.Positions)
  {
    std::array<double, 2> shift;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      shift[axis] =
        Dot(Difference(position, places.Positions[0]), axes[axis]) / places.Spacing[axis];
      least[axis] = std::min(least[axis], shift[axis]);
      most[axis] = std::max(most[axis], shift[axis]);
    }
    this->Shifts.push_back(shift);
  }
  const double height = this->Heights.back();
  const double steps = std::ceil(height / Distances(this->Heights).first - Tolerance);
  FailIf(steps > MostRefined * static_cast<double>(this->Heights.size()),
    "slices are " + Rounded(Distances(this->Heights).first) + " to " +
      Rounded(Distances(this->Heights).second) +
      " mm apart, for which there is no regular grid of a reasonable size; take out those that lie "
      "too near to others");
  this->Placement.Axes = { places.Across, places.Down, places.Normal() };
  this->Placement.Spacing = { places.Spacing[0], places.Spacing[1], height / steps };
  this->Placement.Origin = places.Positions[0];
  this->Size[2] = static_cast<int>(steps) + 1;
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    // On the first slice's pixels: a hair of a pixel, which rounding makes, is none.
    const double before = std::floor(least[axis] + 1e-3);
    const double wider = std::ceil(most[axis] - 1e-3) - before;
    FailIf(wider + this->Size[axis] > std::numeric_limits<int>::max(),
      "its slices lie too far from each other");
    this->Size[axis] += static_cast<int>(wider);
    for (std::size_t c = 0; c < 3; ++c)
    {
      this->Placement.Origin[c] += before * places.Spacing[axis] * axes[axis][c];
    }
    for (std::array<double, 2>& shift : this->Shifts)
    {
      shift[axis] -= before;
    }
  }
}

const GridOfSlices::Layer& GridOfSlices::Need(std::size_t slice)
{
  Layer& layer = this->Layers[slice % 2];
  if (layer.Number != slice)
  {
    layer.Values = this->Slices->Read(static_cast<int>(slice), 1);
    layer.Number = slice;
    layer.Shift = this->Shifts[slice];
  }
  return layer;
}

/** @return whether the slice has a value there, which is added to those of all components. */
bool GridOfSlices::Add(const Layer& layer, int x, int y, double weight, double* values) const
{
  const std::array<int, 3>& size = this->Slices->Size;
  std::array<int, 2> low;
  std::array<double, 2> share;
  const std::array<double, 2> place = { x - layer.Shift[0], y - layer.Shift[1] };
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    const double floor = std::floor(place[axis] + 1e-6);
    if (floor < 0.0 || place[axis] > size[axis] - 1 + 1e-6)
    {
      return false;
    }
    low[axis] = static_cast<int>(floor);
    share[axis] = std::max(0.0, place[axis] - floor);
    share[axis] = low[axis] + 1 >= size[axis] || share[axis] < 1e-6 ? 0.0 : share[axis];
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const int right = corner % 2;
    const int down = corner / 2;
    const double part =
      (right == 1 ? share[0] : 1.0 - share[0]) * (down == 1 ? share[1] : 1.0 - share[1]);
    if (part > 0.0)
    {
      const vtkIdType pixel = static_cast<vtkIdType>(low[1] + down) * size[0] + low[0] + right;
      for (int c = 0; c < this->Components; ++c)
      {
        values[c] += weight * part * layer.Values->GetComponent(pixel, c);
      }
    }
  }
  return true;
}

void GridOfSlices::FillSlice(int z, vtkDataArray* values, vtkIdType start)
{
  const double height = this->Heights.back() * z / (this->Size[2] - 1);
  const auto above = std::upper_bound(this->Heights.begin(), this->Heights.end(), height);
  const std::size_t upper = std::min<std::size_t>(
    std::max<std::ptrdiff_t>(1, above - this->Heights.begin()), this->Heights.size() - 1);
  const Layer& low = this->Need(upper - 1);
  const Layer& high = this->Need(upper);
  double share =
    (height - this->Heights[upper - 1]) / (this->Heights[upper] - this->Heights[upper - 1]);
  // Where a slice is, its own values.
  share = share < 1e-3 ? 0.0 : share > 1.0 - 1e-3 ? 1.0 : share;
  const bool isWhole = values->GetDataType() != VTK_FLOAT && values->GetDataType() != VTK_DOUBLE;
  std::vector<double> sum(static_cast<std::size_t>(this->Components));
  for (int y = 0; y < this->Size[1]; ++y)
  {
    for (int x = 0; x < this->Size[0]; ++x)
    {
      std::fill(sum.begin(), sum.end(), 0.0);
      const bool isThere = (share == 1.0 || this->Add(low, x, y, 1.0 - share, sum.data())) &&
        (share == 0.0 || this->Add(high, x, y, share, sum.data()));
      const vtkIdType at = start + static_cast<vtkIdType>(y) * this->Size[0] + x;
      for (int c = 0; c < this->Components; ++c)
      {
        const double value = isThere ? sum[static_cast<std::size_t>(c)] : this->Outside;
        values->SetComponent(at, c, isWhole ? std::round(value) : value);
      }
    }
  }
}

vtkSmartPointer<vtkDataArray> GridOfSlices::Read(int first, int count)
{
  const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  values->SetNumberOfComponents(this->Components);
  values->SetNumberOfTuples(area * count);
  for (int i = 0; i < count; ++i)
  {
    this->FillSlice(first + i, values, area * i);
  }
  return values;
}
}

Vector3 SlicePlaces::Normal() const
{
  return Cross(this->Across, this->Down);
}

std::vector<double> SlicePlaces::Heights() const
{
  std::vector<double> heights;
  for (const Vector3& position : this->Positions)
  {
    heights.push_back(Dot(Difference(position, this->Positions[0]), this->Normal()));
  }
  return heights;
}

std::string SlicePlaces::Unevenness() const
{
  const std::vector<double> heights = this->Heights();
  if (heights.size() < 2)
  {
    return "";
  }
  const double mean = heights.back() / static_cast<double>(heights.size() - 1);
  const auto [shortest, longest] = Distances(heights);
  if (std::max(longest - mean, mean - shortest) > Tolerance * mean)
  {
    return "slices are " + Rounded(shortest) + " to " + Rounded(longest) +
      " mm apart: some are missing, or they were taken so";
  }
  const Vector3 normal = this->Normal();
  double along = 0.0;
  for (std::size_t i = 1; i < heights.size(); ++i)
  {
    Vector3 aside = Difference(this->Positions[i], this->Positions[i - 1]);
    const double step = Dot(aside, normal);
    for (std::size_t c = 0; c < 3; ++c)
    {
      aside[c] -= step * normal[c];
    }
    along = std::max(along, std::sqrt(Dot(aside, aside)));
  }
  return along <= Tolerance * mean ? ""
                                   : "the gantry was tilted: each slice is shifted by up to " +
      Rounded(along) + " mm against the one before";
}

VolumePlacement SlicePlaces::Placement(double thickness) const
{
  VolumePlacement placement;
  const std::size_t steps = this->Positions.size() - 1;
  placement.Axes = { this->Across, this->Down, this->Normal() };
  placement.Origin = this->Positions[0];
  placement.Spacing = { this->Spacing[0], this->Spacing[1],
    steps == 0 ? thickness : this->Heights().back() / static_cast<double>(steps) };
  return placement;
}

std::unique_ptr<SlabReader> ResampledSlices(
  std::shared_ptr<SlabReader> slices, const SlicePlaces& places, double outside)
{
  return std::make_unique<GridOfSlices>(std::move(slices), places, outside);
}
}
