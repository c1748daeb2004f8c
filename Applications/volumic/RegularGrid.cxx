// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RegularGrid.h"

#include "Messages.h"
#include "Texts.h"

#include <vtkDataArray.h>
#include <vtkMath.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tool
{
namespace
{
/** Tolerated deviation of what two slices lie apart, as a share of it. */
constexpr double Tolerance = 0.05;

/** How many times as many voxels the grid may have. */
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
  GridOfSlices(std::shared_ptr<SlabReader> slices, const SlicePlaces& places, double outside,
    const Opening& opening);

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  struct Layer
  {
    std::size_t Number = std::numeric_limits<std::size_t>::max();
    vtkSmartPointer<vtkDataArray> Values;
  };

  void Widen(const SlicePlaces& places);
  const Layer& Need(std::size_t slice);
  bool Add(const Layer& layer, int x, int y, double weight, double* values) const;
  void FillSlice(int z, vtkDataArray* values, vtkIdType start);

  std::shared_ptr<SlabReader> Slices;
  std::vector<double> Heights;
  std::vector<std::array<double, 2>> Shifts; ///< of their first pixels, in those of the grid
  double Lean = 0.0;                         ///< of each row against the one before, likewise
  double Outside;
  bool AreLabels;
  std::array<Layer, 2> Layers; ///< those that were read last, by even and odd numbers
};

GridOfSlices::GridOfSlices(std::shared_ptr<SlabReader> slices, const SlicePlaces& places,
  double outside, const Opening& opening)
  : Slices(std::move(slices)), Heights(places.Heights()), Outside(outside),
    AreLabels(opening.Choice.AreLabels)
{
  static_cast<SlabReader&>(*this) = *this->Slices;
  this->HasParts = true;
  const double height = this->Heights.back();
  const double steps = std::ceil(height / Distances(this->Heights).first - Tolerance);
  const double lean = Dot(places.Across, places.Down);
  const bool isLeaning = std::abs(lean) > 1e-3; // as HasRightAngles takes it
  const double upright = isLeaning ? std::sqrt(1.0 - lean * lean) : 1.0;
  this->Lean = isLeaning ? lean * places.Spacing[1] / places.Spacing[0] : 0.0;
  this->Placement.Axes = { places.Across, places.Down, places.Normal() };
  for (std::size_t c = 0; isLeaning && c < 3; ++c)
  {
    this->Placement.Axes[1][c] = (places.Down[c] - lean * places.Across[c]) / upright;
  }
  this->Placement.Spacing = { places.Spacing[0], places.Spacing[1] * upright, height / steps };
  this->Placement.Origin = places.Positions[0];
  this->Widen(places);
  const std::array<int, 3>& size = this->Slices->Size;
  const double former = static_cast<double>(size[0]) * size[1] * size[2];
  const double voxels = static_cast<double>(this->Size[0]) * this->Size[1] * (steps + 1.0);
  FailIf(!(voxels < MostRefined * former),
    "the regular grid that holds its slices, which are " + Rounded(Distances(this->Heights).first) +
      " to " + Rounded(Distances(this->Heights).second) + " apart, would have " +
      NumberText(std::round(voxels / former)) +
      " times as many voxels; take out those that lie too near to others, or too far from them");
  this->Size[2] = static_cast<int>(steps) + 1;
}

/** Makes the slices as wide as all together are. */
void GridOfSlices::Widen(const SlicePlaces& places)
{
  std::array<double, 2> least = { 0, 0 };
  std::array<double, 2> most = { 0, 0 };
  const double leans = this->Lean * (this->Size[1] - 1);
  for (const Vector3& position : places.Positions)
  {
    std::array<double, 2> shift;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      shift[axis] = Dot(Difference(position, places.Positions[0]), this->Placement.Axes[axis]) /
        this->Placement.Spacing[axis];
      least[axis] = std::min(least[axis], shift[axis] + (axis == 0 ? std::min(0.0, leans) : 0.0));
      most[axis] = std::max(most[axis], shift[axis] + (axis == 0 ? std::max(0.0, leans) : 0.0));
    }
    this->Shifts.push_back(shift);
  }
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    // On the first slice's pixels: a hair of a pixel, which rounding makes, is none.
    const double before = std::floor(least[axis] + 1e-3);
    const double wider = std::ceil(most[axis] - 1e-3) - before;
    FailIf(!(wider + this->Size[axis] < std::numeric_limits<int>::max()),
      "its slices lie too far from each other");
    this->Size[axis] += static_cast<int>(wider);
    for (std::size_t c = 0; c < 3; ++c)
    {
      this->Placement.Origin[c] +=
        before * this->Placement.Spacing[axis] * this->Placement.Axes[axis][c];
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
  }
  return layer;
}

/** @return whether the slice has a value there, which is added to those of all components. */
bool GridOfSlices::Add(const Layer& layer, int x, int y, double weight, double* values) const
{
  const std::array<int, 3>& size = this->Slices->Size;
  std::array<int, 2> low;
  std::array<double, 2> share;
  const std::array<double, 2>& shift = this->Shifts[layer.Number];
  std::array<double, 2> place = { x - shift[0], y - shift[1] };
  place[0] -= this->Lean * place[1];
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    place[axis] = this->AreLabels ? std::round(place[axis]) : place[axis];
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
  const double near = this->AreLabels ? 0.5 : 1e-3;
  share = share < near ? 0.0 : share > 1.0 - near ? 1.0 : share;
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
  values->SetName(this->Layers[0].Values ? this->Layers[0].Values->GetName() : nullptr);
  return values;
}

/** Slices of a volume that gives them only all at once, or with no less work. */
class HeldSlices : public SlabReader
{
public:
  explicit HeldSlices(SlabReader& volume)
  {
    static_cast<SlabReader&>(*this) = volume;
    this->Values = volume.Read(0, volume.Size[2]);
  }

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
    const auto some = vtkSmartPointer<vtkDataArray>::Take(this->Values->NewInstance());
    some->SetName(this->Values->GetName());
    some->SetNumberOfComponents(this->Components);
    some->InsertTuples(0, area * count, area * first, this->Values);
    return some;
  }

private:
  vtkSmartPointer<vtkDataArray> Values;
};

double LeastOf(SlabReader& volume)
{
  double least = std::numeric_limits<double>::infinity();
  for (int z = 0; z < volume.Size[2]; ++z)
  {
    const vtkSmartPointer<vtkDataArray> values = volume.Read(z, 1);
    for (int c = 0; c < volume.Components; ++c)
    {
      least = std::min(least, RangeOf(values, c)[0]);
    }
  }
  return least;
}
}

Vector3 SlicePlaces::Normal() const
{
  Vector3 normal = Cross(this->Across, this->Down);
  const double along = Dot(normal, Difference(this->Positions.back(), this->Positions.front()));
  const double length = std::copysign(std::sqrt(Dot(normal, normal)), along < 0.0 ? -1.0 : 1.0);
  for (double& c : normal)
  {
    c /= length;
  }
  return normal;
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

std::unique_ptr<SlabReader> ResampledSlices(std::shared_ptr<SlabReader> slices,
  const SlicePlaces& places, const std::string& why, double outside, const Opening& opening)
{
  FailIf(!opening.Choice.Resamples, why + "; without --no-resampling they are resampled");
  const std::array<int, 3> size = slices->Size;
  auto grid = std::make_unique<GridOfSlices>(std::move(slices), places, outside, opening);
  const Vector3& spacing = grid->Placement.Spacing;
  grid->Resampling = why + "; resampled from " + SizeText(size) + " to " + SizeText(grid->Size) +
    " voxels of " + Rounded(spacing[0]) + " x " + Rounded(spacing[1]) + " x " + Rounded(spacing[2]);
  TellOfFile(grid->Resampling);
  return grid;
}

std::shared_ptr<SlabReader> AtRightAngles(
  std::shared_ptr<SlabReader> volume, const Opening& opening)
{
  if (!volume->Placement.HasRightAngles())
  {
    // What headers give as directions need not be unit vectors.
    const std::array<double, 12> n = volume->Placement.Numbers();
    volume->Placement.SetSteps(
      { { { n[0], n[1], n[2] }, { n[3], n[4], n[5] }, { n[6], n[7], n[8] } } });
  }
  const VolumePlacement placement = volume->Placement;
  const std::array<Vector3, 3>& axes = placement.Axes;
  if (placement.HasRightAngles() || !placement.IsSpace() || volume->Size[2] < 2)
  {
    return volume;
  }
  double most = 0.0; // cosine of the angle between two
  for (std::size_t a = 0; a < 3; ++a)
  {
    most = std::max(most, std::abs(Dot(axes[a], axes[(a + 1) % 3])));
  }
  SlicePlaces places;
  places.Across = axes[0];
  places.Down = axes[1];
  places.Spacing = { placement.Spacing[0], placement.Spacing[1] };
  for (int z = 0; z < volume->Size[2]; ++z)
  {
    Vector3 position = placement.Origin;
    for (std::size_t c = 0; c < 3; ++c)
    {
      position[c] += z * placement.Spacing[2] * axes[2][c];
    }
    places.Positions.push_back(position);
  }
  volume = opening.IsWhole || !volume->HasParts ? std::make_shared<HeldSlices>(*volume) : volume;
  const double degrees = 180.0 / vtkMath::Pi() * std::asin(std::min(1.0, most));
  const double outside = opening.Choice.AreLabels ? 0.0 : LeastOf(*volume);
  return ResampledSlices(volume, places,
    "its axes are up to " + Rounded(degrees) + " degrees from right angles",
    std::isfinite(outside) ? outside : 0.0, opening);
}
}
