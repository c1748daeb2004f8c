// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValidVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/VoxelBox.h"
#include "Input/ImageVoxels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace volumic
{
namespace
{
/** The ghost array, or null where no bit of `hidden` is set in it. */
const unsigned char* HidingGhosts(
  vtkDataSetAttributes* attributes, vtkIdType count, unsigned char hidden)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (!ghosts || ghosts->GetNumberOfTuples() != count || ghosts->GetNumberOfComponents() != 1)
  {
    return nullptr;
  }
  const unsigned char* values = ghosts->GetPointer(0);
  const bool hides =
    std::any_of(values, values + count, [hidden](unsigned char g) { return (g & hidden) != 0; });
  return hides ? values : nullptr;
}

/** Marks the corners of all visible cells that are points of the box. */
void MarkVisibleCorners(const unsigned char* ghosts, const VoxelBox& cells, const VoxelBox& points,
  LargeVector<std::uint8_t>& marks)
{
  std::int64_t cell = 0;
  for (int k = cells.First[2]; k < cells.End[2]; ++k)
  {
    for (int j = cells.First[1]; j < cells.End[1]; ++j)
    {
      for (int i = cells.First[0]; i < cells.End[0]; ++i, ++cell)
      {
        for (int corner = 0; corner < 8 && !(ghosts[cell] & vtkDataSetAttributes::HIDDENCELL);
             ++corner)
        {
          const std::array<int, 3> p = { i + (corner & 1), j + (corner >> 1 & 1),
            k + (corner >> 2) };
          // Along an axis of one point there is no other corner.
          if (points.Contains(p))
          {
            marks[points.NumberOf(p[0], p[1], p[2])] = 1;
          }
        }
      }
    }
  }
}

/** The cells of which these points are corners; along an axis of one point there is one. */
VoxelBox CellsOf(const VoxelBox& points)
{
  VoxelBox cells = points;
  for (int axis = 0; axis < 3 && !points.IsEmpty(); ++axis)
  {
    cells.End[axis] = std::max(cells.First[axis] + 1, cells.End[axis] - 1);
  }
  return cells;
}

LargeVector<std::uint8_t> NotBlanked(vtkImageData* image)
{
  LargeVector<std::uint8_t> marks;
  const unsigned char* cells =
    HidingGhosts(image->GetCellData(), image->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL);
  const unsigned char* points = HidingGhosts(
    image->GetPointData(), image->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT);
  if (cells)
  {
    const int* size = image->GetDimensions();
    const VoxelBox all = VoxelBox::Of({ size[0], size[1], size[2] });
    marks.assign(static_cast<std::size_t>(all.Count()), 0);
    MarkVisibleCorners(cells, CellsOf(all), all, marks);
  }
  if (points)
  {
    marks.resize(static_cast<std::size_t>(image->GetNumberOfPoints()), 1);
    std::transform(marks.begin(), marks.end(), points, marks.begin(),
      [](std::uint8_t mark, unsigned char ghost)
      { return ghost & vtkDataSetAttributes::HIDDENPOINT ? std::uint8_t(0) : mark; });
  }
  return marks;
}

/** Voxels of one kind: how many, and which is the first. */
struct CountedVoxels
{
  std::int64_t Count = 0;
  std::int64_t First = -1;
};

struct NotFinite
{
  CountedVoxels NaNs;
  CountedVoxels Infinite;
};

/** Of those marked as valid. */
template <typename T>
NotFinite CountNotFinite(
  const T* values, std::int64_t count, const LargeVector<std::uint8_t>& marks)
{
  NotFinite found;
  if constexpr (std::is_floating_point_v<T>)
  {
    for (std::int64_t n = 0; n < count; ++n)
    {
      if (!std::isfinite(values[n]) && (marks.empty() || marks[n] != 0))
      {
        CountedVoxels& of = std::isnan(values[n]) ? found.NaNs : found.Infinite;
        of.First = of.Count++ == 0 ? n : of.First;
      }
    }
  }
  return found;
}

template <typename T>
void ExcludeNaNs(const T* values, std::int64_t count, LargeVector<std::uint8_t>& marks)
{
  marks.resize(static_cast<std::size_t>(count), 1);
  for (std::int64_t i = 0; i < count; ++i)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      marks[i] = std::isnan(values[i]) ? std::uint8_t(0) : marks[i];
    }
  }
}

template <typename T>
void FindRange(const T* values, const LargeVector<std::uint8_t>& marks, double range[2])
{
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    const auto value = static_cast<double>(values[i]);
    range[0] = marks[i] != 0 && value < range[0] ? value : range[0];
    range[1] = marks[i] != 0 && value > range[1] ? value : range[1];
  }
}

/** `3 NaN voxels, the first at (i, j, k)` */
std::string Describe(const char* kind, std::int64_t count, const std::string& share,
  std::int64_t first, vtkImageData* image)
{
  const int* extent = image->GetExtent();
  const int* size = image->GetDimensions();
  const std::int64_t row = first / size[0];
  return Join(count, " ", kind, " voxel", count == 1 ? "" : "s", share, ", the first at (",
    extent[0] + first % size[0], ", ", extent[2] + row % size[1], ", ", extent[4] + row / size[1],
    ")");
}
}

ValidVoxels FindValidVoxels(vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image,
  bool nanIsBackground, Executor& executor)
{
  ValidVoxels valid;
  valid.Marks = NotBlanked(image);
  const std::int64_t count = contiguous->GetNumberOfTuples();
  NotFinite found;
  VisitVoxels(contiguous,
    [&](const auto* values)
    {
      if (FindNotFiniteVoxels(values, count, executor).Count > 0)
      {
        found = CountNotFinite(values, count, valid.Marks);
        ExcludeNaNs(values, count, valid.Marks);
      }
    });
  if (found.Infinite.Count > 0)
  {
    Refuse(NameOf(original), " has ",
      Describe("infinite", found.Infinite.Count, "", found.Infinite.First, image),
      ". Replace them by numbers, for instance by the value of the background.");
  }
  valid.NaNs = found.NaNs.Count;
  valid.FirstNaN = found.NaNs.First;
  if (valid.NaNs > 0 && !nanIsBackground)
  {
    Refuse(NameOf(original), " has ", Describe("NaN", valid.NaNs, "", valid.FirstNaN, image),
      ". Turn NaN Is Background on, or replace them by numbers.");
  }
  return valid;
}

std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid)
{
  std::array<double, 2> range = { std::numeric_limits<double>::max(),
    std::numeric_limits<double>::lowest() };
  if (valid.Marks.empty())
  {
    contiguous->GetRange(range.data());
    return range;
  }
  VisitVoxels(
    contiguous, [&](const auto* values) { FindRange(values, valid.Marks, range.data()); });
  return range;
}

void CheckAnyIsValid(vtkDataArray* original, const ValidVoxels& valid)
{
  if (!valid.Marks.empty() &&
    std::find(valid.Marks.begin(), valid.Marks.end(), std::uint8_t(1)) == valid.Marks.end())
  {
    Refuse("all voxels of ", NameOf(original), " are NaN or blanked: there is nothing to see.");
  }
}

std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid)
{
  const double share =
    100.0 * static_cast<double>(valid.NaNs) / static_cast<double>(image->GetNumberOfPoints());
  const std::string percent =
    share < 0.1 ? std::string() : Join(" (", std::round(share * 10.0) / 10.0, " %)");
  return Join(NameOf(original), " has ",
    Describe("NaN", valid.NaNs, percent, valid.FirstNaN, image),
    ". They count as background; switch NaN Is Background off to refuse them.");
}
}
