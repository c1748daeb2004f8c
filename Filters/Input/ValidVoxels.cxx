// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValidVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/LevelReduction.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStructuredData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace volumic
{
namespace
{
/** Return the values of a ghost array, or null if none has a bit of `hidden`. */
const unsigned char* HidingGhosts(
  vtkUnsignedCharArray* ghosts, vtkIdType count, unsigned char hidden)
{
  if (!ghosts || ghosts->GetNumberOfTuples() != count || ghosts->GetNumberOfComponents() != 1)
  {
    return nullptr;
  }
  const unsigned char* values = ghosts->GetPointer(0);
  const auto hides = [hidden](unsigned char g) { return (g & hidden) != 0; };
  return std::any_of(values, values + count, hides) ? values : nullptr;
}

LargeVector<std::uint8_t> NotBlanked(vtkImageData* image)
{
  LargeVector<std::uint8_t> marks;
  const vtkIdType count = image->GetNumberOfPoints();
  const unsigned char* cells = HidingGhosts(
    image->GetCellGhostArray(), image->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL);
  const unsigned char* points =
    HidingGhosts(image->GetPointGhostArray(), count, vtkDataSetAttributes::HIDDENPOINT);
  if (cells)
  {
    marks.assign(static_cast<std::size_t>(count), 0);
    vtkNew<vtkIdList> corners;
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
    {
      if (!(cells[cell] & vtkDataSetAttributes::HIDDENCELL))
      {
        image->GetCellPoints(cell, corners);
        for (const vtkIdType point : *corners)
        {
          marks[static_cast<std::size_t>(point)] = 1;
        }
      }
    }
  }
  if (points)
  {
    marks.resize(static_cast<std::size_t>(count), 1);
    std::transform(marks.begin(), marks.end(), points, marks.begin(),
      [](std::uint8_t mark, unsigned char ghost)
      { return ghost & vtkDataSetAttributes::HIDDENPOINT ? std::uint8_t(0) : mark; });
  }
  return marks;
}

/** Count and unmark the marked voxels that are not finite. */
template <typename T>
void CountNotFinite(const T* values, LargeVector<std::uint8_t>& marks, NotFiniteVoxels& nans,
  NotFiniteVoxels& infinite)
{
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    const auto value = static_cast<double>(values[i]);
    if (marks[i] != 0 && !std::isfinite(value))
    {
      NotFiniteVoxels& kind = std::isnan(value) ? nans : infinite;
      kind.First = kind.Count++ == 0 ? static_cast<std::int64_t>(i) : kind.First;
      marks[i] = 0;
    }
  }
}

/** Return `array 'name' has 3 NaN voxels (1.5 %), the first at (i, j, k)`. */
std::string Describe(vtkDataArray* array, const char* kind, std::int64_t count, std::int64_t first,
  vtkImageData* image)
{
  int at[3];
  vtkStructuredData::ComputePointStructuredCoordsForExtent(first, image->GetExtent(), at);
  const double percent =
    100.0 * static_cast<double>(count) / static_cast<double>(image->GetNumberOfPoints());
  return Join(NameOf(array), " has ", count, " ", kind, " voxel", count == 1 ? "" : "s",
    percent < 0.1 ? std::string() : Join(" (", std::round(percent * 10.0) / 10.0, " %)"),
    ", the first at (", at[0], ", ", at[1], ", ", at[2], ")");
}
}

ValidVoxels FindValidVoxels(vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image,
  bool nanIsBackground, Executor& executor)
{
  ValidVoxels valid;
  valid.Marks = NotBlanked(image);
  const std::int64_t count = contiguous->GetNumberOfTuples();
  NotFiniteVoxels nans;
  NotFiniteVoxels infinite;
  VisitVoxels(contiguous,
    [&](const auto* values)
    {
      if (FindNotFiniteVoxels(values, count, executor).Count > 0)
      {
        valid.Marks.resize(static_cast<std::size_t>(count), 1);
        CountNotFinite(values, valid.Marks, nans, infinite);
      }
    });
  if (infinite.Count > 0)
  {
    ThrowInvalidArgument(Describe(original, "infinite", infinite.Count, infinite.First, image),
      ". Replace them by numbers, such as the background value.");
  }
  if (nans.Count > 0 && !nanIsBackground)
  {
    ThrowInvalidArgument(Describe(original, "NaN", nans.Count, nans.First, image),
      ". Switch NaN Is Background on, or replace them by numbers.");
  }
  valid.NaNs = nans.Count;
  valid.FirstNaN = nans.First;
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
  VisitVoxels(contiguous,
    [&](const auto* values)
    {
      for (std::size_t i = 0; i < valid.Marks.size(); ++i)
      {
        const auto value = static_cast<double>(values[i]);
        range[0] = valid.Marks[i] != 0 ? std::min(range[0], value) : range[0];
        range[1] = valid.Marks[i] != 0 ? std::max(range[1], value) : range[1];
      }
    });
  return range;
}

void CheckAnyIsValid(vtkDataArray* original, const ValidVoxels& valid)
{
  if (!valid.Marks.empty() &&
    std::find(valid.Marks.begin(), valid.Marks.end(), std::uint8_t(1)) == valid.Marks.end())
  {
    ThrowInvalidArgument(
      "all voxels of ", NameOf(original), " are NaN or blanked. Choose another array or image.");
  }
}

std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid)
{
  return Describe(original, "NaN", valid.NaNs, valid.FirstNaN, image) +
    ". They are background. Switch NaN Is Background off to report an error instead.";
}
}
