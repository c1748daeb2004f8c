// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "ImageVoxels.h"

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

/** Marks the corners of all visible cells. */
void MarkVisibleCorners(
  const unsigned char* ghosts, const int* size, LargeVector<std::uint8_t>& marks)
{
  int cells[3];
  std::transform(size, size + 3, cells, [](int points) { return std::max(1, points - 1); });
  const std::int64_t row = size[0];
  const std::int64_t slice = row * size[1];
  std::int64_t cell = 0;
  for (int k = 0; k < cells[2]; ++k)
  {
    for (int j = 0; j < cells[1]; ++j)
    {
      for (int i = 0; i < cells[0]; ++i, ++cell)
      {
        for (int corner = 0; corner < 8 && !(ghosts[cell] & vtkDataSetAttributes::HIDDENCELL);
             ++corner)
        {
          // Along an axis of one point there is no other corner.
          const int x = std::min(i + (corner & 1), size[0] - 1);
          const int y = std::min(j + (corner >> 1 & 1), size[1] - 1);
          const int z = std::min(k + (corner >> 2), size[2] - 1);
          marks[x + y * row + z * slice] = 1;
        }
      }
    }
  }
}

/** Empty where nothing is blanked. */
LargeVector<std::uint8_t> NotBlanked(vtkImageData* image)
{
  LargeVector<std::uint8_t> marks;
  const auto count = static_cast<std::size_t>(image->GetNumberOfPoints());
  if (const unsigned char* ghosts = HidingGhosts(
        image->GetCellData(), image->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL))
  {
    marks.assign(count, 0);
    MarkVisibleCorners(ghosts, image->GetDimensions(), marks);
  }
  if (const unsigned char* ghosts = HidingGhosts(
        image->GetPointData(), image->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT))
  {
    marks.resize(count, 1);
    std::transform(marks.begin(), marks.end(), ghosts, marks.begin(),
      [](std::uint8_t mark, unsigned char ghost)
      { return ghost & vtkDataSetAttributes::HIDDENPOINT ? std::uint8_t(0) : mark; });
  }
  return marks;
}

struct InfiniteVoxels
{
  std::int64_t Count = 0;
  std::int64_t First = -1;
};

/** Takes the NaN out of those that are valid. */
template <typename T>
InfiniteVoxels ExcludeNaNs(const T* values, std::int64_t count, ValidVoxels& valid)
{
  InfiniteVoxels infinite;
  if constexpr (std::is_floating_point_v<T>)
  {
    valid.Marks.resize(static_cast<std::size_t>(count), 1);
    for (std::int64_t i = 0; i < count; ++i)
    {
      if (valid.Marks[i] != 0 && std::isnan(values[i]))
      {
        valid.Marks[i] = 0;
        valid.FirstNaN = valid.NaNs == 0 ? i : valid.FirstNaN;
        ++valid.NaNs;
      }
      else if (valid.Marks[i] != 0 && std::isinf(values[i]))
      {
        infinite.First = infinite.Count == 0 ? i : infinite.First;
        ++infinite.Count;
      }
    }
  }
  return infinite;
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
std::string Describe(
  const char* kind, std::int64_t count, const std::string& share, std::int64_t first,
  vtkImageData* image)
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
  NotFiniteVoxels found;
  InfiniteVoxels infinite;
  switch (contiguous->GetDataType())
  {
    vtkTemplateMacro({
      const auto* values = static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0));
      found = FindNotFiniteVoxels(values, image->GetNumberOfPoints(), executor);
      if (found.Count > 0)
      {
        infinite = ExcludeNaNs(values, image->GetNumberOfPoints(), valid);
      }
    });
    default:
      break;
  }
  if (infinite.Count > 0)
  {
    Refuse(NameOf(original), " has ",
      Describe("infinite", infinite.Count, "", infinite.First, image),
      ". Replace them by numbers, for instance by the value of the background.");
  }
  if (valid.NaNs > 0 && !nanIsBackground)
  {
    Refuse(NameOf(original), " has ", Describe("NaN", valid.NaNs, "", valid.FirstNaN, image),
      ". Turn NaN Is Background on, or replace them by numbers.");
  }
  return valid;
}

std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid)
{
  std::array<double, 2> range;
  if (valid.Marks.empty())
  {
    contiguous->GetRange(range.data());
    return range;
  }
  range = { std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest() };
  switch (contiguous->GetDataType())
  {
    vtkTemplateMacro(FindRange(
      static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0)), valid.Marks, range.data()));
    default:
      break;
  }
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
    ". They count as background; turn NaN Is Background off to refuse them.");
}
}
